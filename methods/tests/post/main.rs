//! Tests of `post` through its public face: laws, known answers, and numbers of the reference implementations.

mod comparison;
mod laws;
mod patterns;
mod reference_values;
mod ztest;
