//! Light transport, scalar: what both twins of a kernel do to one ray, one surface, one light. Each file is the twin of
//! `backend-gpu/src/shared/<stem>.wgsl`, function by function, operation by operation.

pub mod intersect;
