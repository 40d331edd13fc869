//! The few forms of Markdown that reports use.

/// A table; cells are made safe, columns named in `right` are aligned to the right.
pub(crate) struct MarkdownTable {
    text: String,
    rows: usize,
}

/// Alignment of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Right,
}

impl MarkdownTable {
    pub(crate) fn new(header: &[(&str, Align)]) -> Self {
        let mut text = String::new();
        push_row(&mut text, header.iter().map(|(name, _)| (*name).to_owned()));
        let rule = |align: &Align| match align {
            Align::Left => "---".to_owned(),
            Align::Right => "---:".to_owned(),
        };
        push_row(&mut text, header.iter().map(|(_, align)| rule(align)));
        Self { text, rows: 0 }
    }

    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        push_row(&mut self.text, cells.into_iter());
        self.rows += 1;
    }

    /// The table with an empty line after it; nothing at all without rows.
    pub(crate) fn finish(self) -> String {
        if self.rows == 0 { String::new() } else { self.text + "\n" }
    }
}

fn push_row(text: &mut String, cells: impl Iterator<Item = String>) {
    text.push('|');
    for cell in cells {
        text.push(' ');
        text.push_str(&one_line(&cell).replace('|', "\\|"));
        text.push_str(" |");
    }
    text.push('\n');
}

/// Line breaks and runs of blanks become single blanks.
pub(crate) fn one_line(text: &str) -> String {
    // A no-break space inside a number is no blank.
    text.split([' ', '\n', '\r', '\t']).filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Text as it is: none of its letters means anything to Markdown.
pub(crate) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        if matches!(letter, '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>') {
            safe.push('\\');
        }
        safe.push(letter);
    }
    safe
}

/// Text for HTML, as SVG is.
pub(super) fn html(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A section that is closed at first; nothing if it is empty.
pub(super) fn details(summary: &str, body: &str) -> String {
    if body.is_empty() {
        String::new()
    } else {
        format!("<details><summary>{summary}</summary>\n\n{body}</details>\n\n")
    }
}

/// The first sentence of a text; abbreviations such as `s. 3.6` and `Fig. 18` do not end one.
pub(crate) fn first_sentence(text: &str) -> String {
    let text = one_line(text);
    let ends = text.match_indices(". ").find(|(at, _)| {
        let before = text[..*at].rsplit(' ').next().unwrap_or("");
        let short = matches!(before.trim_start_matches('('), "s" | "Fig" | "Figs" | "cf" | "e.g" | "i.e" | "vs" | "no");
        let capital = text[at + 2..].chars().next().is_some_and(char::is_uppercase);
        capital && !short
    });
    match ends {
        Some((at, _)) => text[..=at].to_owned(),
        None => text,
    }
}

/// `1 entry`, `2 entries`.
pub(crate) fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
