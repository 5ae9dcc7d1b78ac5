//! A small, strict expression language for fields of position and time
