//! The program as users run it.

use std::path::Path;
use std::process::{Command, Output};

use libtest_mimic::Failed;

/// The program with arguments, in the repository's folder.
pub fn luminaire(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
    command.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR"));
    command
}

/// Runs it; a panic or a signal is a failure.
pub fn run(arguments: &[&str]) -> Result<Output, Failed> {
    let output = luminaire(arguments).output()?;
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    if errors.contains("panicked") || output.status.code().is_none() {
        return Err(format!("{arguments:?} panicked or was killed:\n{errors}").into());
    }
    Ok(output)
}

/// Runs a command that must fail with status 1 and a message that holds each of `expected`, and must leave `folder` empty.
pub fn refused(arguments: &[&str], expected: &[&str], folder: &Path) -> Result<(), Failed> {
    let output = run(arguments)?;
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.code() != Some(1) {
        return Err(format!("{arguments:?} ended with {:?}:\n{errors}", output.status.code()).into());
    }
    for text in expected {
        if !errors.contains(text) {
            return Err(format!("{arguments:?} does not say `{text}`:\n{errors}").into());
        }
    }
    if errors.contains('\u{1b}') {
        return Err("colours without a terminal".into());
    }
    let left: Vec<_> = std::fs::read_dir(folder)?.flatten().map(|entry| entry.file_name()).collect();
    if left.is_empty() { Ok(()) } else { Err(format!("{arguments:?} left {left:?}").into()) }
}

/// Runs a command that must succeed.
pub fn done(arguments: &[&str]) -> Result<(), Failed> {
    let output = run(arguments)?;
    let errors = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(0) { Ok(()) } else { Err(format!("{arguments:?}: {errors}").into()) }
}
