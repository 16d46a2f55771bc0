//! What goes wrong on a device, turned into diagnostics that name the pass.
//!
//! wgpu panics on an error that nobody catches. [`ErrorSink::install`] runs before anything else is asked of a device and
//! collects such errors instead; [`catch`] collects those of a piece of work, so that they can be said of a pass.
//!
//! Guarantee: no error of wgpu's that is reported through its error interface reaches a panic.

use std::future::Future;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::{Plan, Step};
use luminaire_graph::source::Span;

/// Errors that no scope caught, and whether the device still stands. Clones share their content.
#[derive(Debug, Clone, Default)]
pub(crate) struct ErrorSink {
    shared: Arc<Mutex<Sunk>>,
}

#[derive(Debug, Default)]
struct Sunk {
    uncaught: Vec<wgpu::Error>,
    lost: Option<String>,
}

impl ErrorSink {
    /// Makes the device report to this sink.
    pub(crate) fn install(&self, device: &wgpu::Device) {
        let sink = self.clone();
        device.on_uncaptured_error(Arc::new(move |error| sink.lock().uncaught.push(error)));
        let sink = self.clone();
        device.set_device_lost_callback(move |reason, message| {
            // Dropping the device at the end reports `Destroyed`, when nobody asks any more.
            sink.lock().lost = Some(if message.is_empty() { format!("{reason:?}") } else { message });
        });
    }

    /// Takes the errors out that no scope caught.
    pub(crate) fn take(&self) -> Vec<wgpu::Error> {
        std::mem::take(&mut self.lock().uncaught)
    }

    /// Why the device is gone, if it is.
    pub(crate) fn lost(&self) -> Option<Diagnostic> {
        let reason = self.lock().lost.clone()?;
        Some(
            Diagnostic::error("execute::device-lost", format!("the device was lost: {reason}"))
                .note("everything that it held is gone")
                .hint("render again; if it happens again, a pass may run too long for the driver's watchdog"),
        )
    }

    fn lock(&self) -> MutexGuard<'_, Sunk> {
        // A panic while the lock was held leaves a list of errors, which is still a list of errors.
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Does some work and returns the errors that it raised on the device.
pub(crate) fn catch<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> (T, Vec<wgpu::Error>) {
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    // A scope keeps its first error; what follows from it is noise.
    let errors = [block_on(validation.pop()), block_on(memory.pop()), block_on(internal.pop())];
    (result, errors.into_iter().flatten().collect())
}

/// Waits for a future of wgpu's, which on native backends is ready at once.
pub(crate) fn block_on<F: Future>(future: F) -> F::Output {
    let mut future = std::pin::pin!(future);
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    loop {
        if let std::task::Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
        std::thread::yield_now();
    }
}

/// Whom an error is about.
#[derive(Debug, Clone)]
pub(crate) struct Subject {
    /// As the subject of a sentence: `pass "shade" (shaders/lit.wgsl)`.
    pub(crate) what: String,
    /// Where it stands.
    pub(crate) span: Span,
    /// Beside the place.
    pub(crate) label: &'static str,
}

impl Subject {
    /// A step, with its shader file.
    pub(crate) fn step(plan: &Plan, step: &Step) -> Subject {
        let shader = step.shader.and_then(|index| plan.shaders.get(index));
        let what = match shader {
            Some(shader) => format!("pass `{}` ({})", step.name, shader.path),
            None => format!("pass `{}`", step.name),
        };
        Subject { what, span: step.span, label: "this pass" }
    }

    /// Something that has no place in a file.
    pub(crate) fn nowhere(what: impl Into<String>) -> Subject {
        Subject { what: what.into(), span: Span::NOWHERE, label: "" }
    }

    /// An error about the subject; `message` follows its name after a colon.
    pub(crate) fn error(&self, code: &'static str, message: impl AsRef<str>) -> Diagnostic {
        let diagnostic = Diagnostic::error(code, format!("{}: {}", self.what, message.as_ref()));
        if self.span.is_somewhere() { diagnostic.at(self.span, self.label) } else { diagnostic }
    }

    /// What wgpu says, about the subject.
    pub(crate) fn wgpu_error(&self, error: &wgpu::Error) -> Diagnostic {
        match error {
            wgpu::Error::OutOfMemory { .. } => self
                .error("execute::out-of-memory", "the device is out of memory")
                .hint("render at a smaller size, or lower the parameters that size its resources"),
            wgpu::Error::Validation { description, .. } => with_lines(self, "execute::validation", "wgpu refuses it", description),
            wgpu::Error::Internal { description, .. } => with_lines(self, "execute::internal", "the driver failed", description),
        }
    }

    /// The first of several errors, with the others as notes; `Ok` if there are none.
    pub(crate) fn check(&self, errors: &[wgpu::Error]) -> Result<(), Diagnostic> {
        let Some((first, rest)) = errors.split_first() else { return Ok(()) };
        Err(rest.iter().fold(self.wgpu_error(first), |diagnostic, error| diagnostic.note(error.to_string().trim().to_owned())))
    }
}

/// wgpu writes a chain of causes over several lines: the last one says what is wrong, the others where.
fn with_lines(subject: &Subject, code: &'static str, lead: &str, description: &str) -> Diagnostic {
    let mut lines: Vec<&str> = description.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let last = lines.pop().unwrap_or("no reason given");
    lines.into_iter().fold(subject.error(code, format!("{lead}: {last}")), |diagnostic, line| diagnostic.note(line.to_owned()))
}
