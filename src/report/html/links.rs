//! Links between the files of the Markdown as links within the document.
//!
//! A section has the id of its experiment, and what is marked on a page has the id of both: `#ch3-gap`, `#ch3-gap/maximum`,
//! as the command names an entry.

pub(super) use super::super::motions::PAGE as WHAT_MOVES;
use super::super::view::ExperimentView;
pub(super) use super::super::what_stands::PAGE as WHAT_STANDS;
use super::Pages;

/// Names below `reports/`.
pub(super) const INDEX: &str = "README.md";
pub(super) const ASSUMPTIONS: &str = "assumptions.md";
pub(super) const TOLERANCES: &str = "tolerances.md";

/// Which pages are sections.
pub(super) struct Links {
    pages: Pages,
}

impl Links {
    pub(super) fn new(experiments: &[ExperimentView<'_>]) -> Self {
        let own = [INDEX, WHAT_STANDS, WHAT_MOVES, ASSUMPTIONS, TOLERANCES];
        let own = own.into_iter().map(|page| (page.to_owned(), section_of(page).to_owned()));
        let experiments = experiments.iter().map(|view| (view.page.clone(), view.experiment.id.to_string()));
        Self { pages: own.chain(experiments).collect() }
    }

    /// The link within the document, or out into the web; `None` for a file that is no part of it.
    pub(super) fn resolve(&self, from: &str, link: &str) -> Option<String> {
        if link.starts_with("https://") || link.starts_with("http://") {
            return Some(link.to_owned());
        }
        let (file, mark) = link.split_once('#').unwrap_or((link, ""));
        let page = if file.is_empty() { from.to_owned() } else { joined(from, file) };
        let section = self.pages.get(&page)?;
        Some(if mark.is_empty() { format!("#{section}") } else { format!("#{}", marked(section, mark)) })
    }
}

/// The id of a page of the study as a whole.
pub(super) fn section_of(page: &'static str) -> &'static str {
    if page == INDEX { "study" } else { page.trim_end_matches(".md") }
}

/// The id of what is marked on a page.
pub(super) fn marked(section: &str, mark: &str) -> String {
    format!("{section}/{}", mark.strip_prefix("entry-").unwrap_or(mark))
}

/// A link from one file as a name below `reports/`.
pub(in crate::report) fn joined(from: &str, link: &str) -> String {
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in link.split('/') {
        match part {
            ".." => {
                parts.pop();
            }
            "." | "" => {}
            part => parts.push(part),
        }
    }
    parts.join("/")
}
