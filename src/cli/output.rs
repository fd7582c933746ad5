//! Writing to stdout and stderr without a panic when nobody listens.

use super::Ending;
use crate::diagnostic::InputError;
use std::io::{self, ErrorKind, IsTerminal, Write};

/// Prints `text` as it is to stdout. A reader that has gone away (`| head`) is no failure.
pub(super) fn print(text: &str) -> Ending {
    let mut stdout = io::stdout().lock();
    let written = stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush());
    match written {
        Ok(()) => Ending::Done,
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ending::Done,
        Err(error) => {
            message(&format!("error: cannot write to stdout: {error}"));
            Ending::Failed
        }
    }
}

/// Prints a line to stderr.
pub(super) fn message(text: &str) {
    // Nothing is left to tell it to if stderr is closed.
    let _ = writeln!(io::stderr(), "{text}");
}

/// Prints a mistake of the user to stderr.
pub(super) fn bad_input(error: &InputError) -> Ending {
    message(&error.render(colours()));
    Ending::BadInput
}

fn colours() -> bool {
    // https://no-color.org: any value but an empty one turns colours off.
    let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    io::stderr().is_terminal() && !refused
}
