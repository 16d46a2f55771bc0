//! The command line. Everything it does is in the library; this only turns a result into an exit status.

use std::process::ExitCode;

fn main() -> ExitCode {
    luminaire::cli::run()
}
