//! The document around the sections: head, navigation, style and script.
//!
//! Its policy forbids every request, and every script but its own: the script carries a hash of the whole text, which no text
//! within can know.

use super::super::markdown::html;

const STYLE: &str = include_str!("style.css");
const SCRIPT: [&str; 4] =
    [include_str!("pages.js"), include_str!("table.js"), include_str!("values.js"), include_str!("motion.js")];

/// A page of the document.
pub(super) struct Section {
    id: String,
    title: String,
    body: String,
}

impl Section {
    pub(super) fn new(id: &str, title: &str, body: String) -> Self {
        Self { id: id.to_owned(), title: title.to_owned(), body }
    }
}

/// The HTML file.
pub(super) fn document(sections: &[Section]) -> String {
    let mut body = String::new();
    for Section { id, title, body: text } in sections {
        body +=
            &format!("<section class=\"page\" id=\"{}\" data-title=\"{}\">\n{text}</section>\n", html(id), html(title));
    }
    let script = SCRIPT.concat();
    let nonce = blake3::hash(format!("{body}{script}").as_bytes()).to_hex();
    include_str!("shell.html")
        .replace("{nonce}", &nonce)
        .replace("{style}", STYLE)
        .replace("{script}", &script)
        // Last, so that nothing in it is taken for a place to fill.
        .replace("{body}", &body)
}
