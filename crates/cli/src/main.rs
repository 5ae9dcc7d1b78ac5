//! The `meshless` command.
fn main() {}
