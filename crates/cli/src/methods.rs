//! `meshless methods`.

use meshless::METHODS;

use crate::Failure;

pub(crate) fn run() -> Result<(), Failure> {
    say!("{:<28} {:<11} {:<10} limits", "method", "order", "dimensions");
    for method in METHODS {
        say!("{:<28} {:<11} {:<10} {}", method.name, method.order, method.dimensions, method.limits);
    }
    Ok(())
}
