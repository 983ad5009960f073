//! The mathematics kernels share. Each file is the twin of `backend-gpu/src/shared/<stem>.wgsl`.
