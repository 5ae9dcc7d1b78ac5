//! Gallery of problems with known solutions, and the tests of the whole product.
