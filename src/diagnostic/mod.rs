//! What a user did wrong in an input file: where it stands, what was found there, what was
//! expected and how to mend it.
//!
//! [`Source`] is a file's text, [`Document`] its TOML with the place of every key and value.
//! Readers take typed values from its [`Table`]s; whatever is wrong goes to [`Problems`], which
//! keeps the first problem in file order, and comes out as one [`InputError`] at the end.

mod document;
mod error;
mod nearest;
mod source;
mod table;

pub use document::{Document, Item, Place, Problems};
pub use error::{InputError, Problem};
pub use nearest::nearest;
pub use source::Source;
pub use table::{Entry, Table};
