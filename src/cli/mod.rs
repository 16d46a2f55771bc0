//! The command line: one file per command.

mod arguments;
mod check;
mod explain;
mod frames;
mod info;
mod pattern;
mod plan;
mod progress;
mod render;
mod scene;
mod sequence;
mod sheet;
mod stats;
mod target;

use std::io::{IsTerminal, Write};
use std::process::ExitCode;

use clap::Parser;
use luminaire_graph::diagnostic::{Diagnostic, has_errors, render as render_diagnostics};
use luminaire_graph::source::SourceMap;

use arguments::{Arguments, Command};

/// Runs the program with the process's arguments.
pub fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match &arguments.command {
        Command::Render(arguments) => render::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Plan(arguments) => plan::run(arguments),
        Command::Explain(arguments) => explain::run(arguments),
        Command::Scene(arguments) => scene::run(arguments),
        Command::Sheet(arguments) => sheet::run(arguments),
        Command::Info => info::run(),
    };
    if done { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Prints problems on standard error, in colours on a terminal only. Returns whether none is an error.
fn report(diagnostics: &[Diagnostic], sources: &SourceMap) -> bool {
    let color = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    // Nobody is left to tell if standard error is closed.
    let _ = std::io::stderr().write_all(render_diagnostics(diagnostics, sources, color).as_bytes());
    !has_errors(diagnostics)
}

/// Prints a result on standard output. A closed pipe is the reader's wish to stop.
fn print(text: &str) -> bool {
    match std::io::stdout().write_all(text.as_bytes()).and_then(|()| std::io::stdout().flush()) {
        Ok(()) => true,
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => true,
        Err(error) => {
            let message = format!("can't write to standard output: {error}");
            report(&[Diagnostic::error("output::write", message).hint("direct it elsewhere")], &SourceMap::default())
        }
    }
}
