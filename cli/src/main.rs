//! The `twinlight` command.
fn main() {}
