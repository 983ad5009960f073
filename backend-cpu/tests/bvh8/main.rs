//! The eight-wide hierarchy against the meaning of a hit, at every vector width.

mod common;
mod hits;
mod watertight;
