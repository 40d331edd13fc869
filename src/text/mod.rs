//! Words and numbers as a reader meets them: the same formatter and the same vocabulary in figures,
//! reports and on the console.

pub mod braces;
#[cfg(feature = "pipeline")]
pub(crate) mod json;
pub mod name;
pub mod number;
pub mod utf8;
pub mod words;
