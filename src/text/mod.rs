//! Words and numbers as a reader meets them: the same formatter and the same vocabulary in figures,
//! reports and on the console.

pub mod braces;
pub mod number;
pub mod utf8;
pub mod words;
