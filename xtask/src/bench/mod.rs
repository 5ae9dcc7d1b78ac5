//! Not built yet.
pub(crate) fn run(_arguments: &[String]) -> std::process::ExitCode {
    std::process::ExitCode::FAILURE
}
