//! Meshless discretisations of elliptic interface problems, one method a folder
