//! The figures as elements of the document: those on disk where they are up to date, others drawn now.

use std::collections::BTreeMap;

use super::super::markdown::html as escaped;
use super::super::pages::{NotDrawn, svgs};
use super::super::verdicts::Judgement;
use crate::study::Study;

/// SVGs by their names below `reports/`, without ending.
#[derive(Default)]
pub(super) struct Figures {
    drawn: BTreeMap<String, Result<String, NotDrawn>>,
}

impl Figures {
    pub(super) fn of(study: &Study, judgement: &Judgement) -> Self {
        let name = |name: String| name.trim_start_matches("reports/").trim_end_matches(".svg").to_owned();
        Self { drawn: svgs(study, judgement).into_iter().map(|(file, svg)| (name(file), svg)).collect() }
    }

    /// The figure that the Markdown shows as this file.
    pub(super) fn get(&self, file: &str, caption: &str) -> String {
        let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        match self.drawn.get(stem) {
            Some(Ok(svg)) => figure(svg, caption),
            Some(Err(why)) => missing(&format!("cannot be drawn: {why}"), caption),
            None => missing("not drawn, as there is no result yet", caption),
        }
    }

    /// What could not be drawn, in words.
    pub(super) fn problems(&self) -> Vec<String> {
        let problem =
            |(name, svg): (&String, &Result<String, NotDrawn>)| Some(format!("{name}: {}", svg.as_ref().err()?));
        self.drawn.iter().filter_map(problem).collect()
    }
}

/// An SVG within the document; its size is that of the page.
pub(super) fn figure(svg: &str, caption: &str) -> String {
    let caption = escaped(caption);
    let (open, body) = svg.split_once('>').unwrap_or(("<svg", svg));
    let keep = |name: &str| {
        let (_, rest) = open.split_once(&format!(" {name}=\""))?;
        Some(format!(" {name}=\"{}\"", rest.split('"').next()?))
    };
    let attributes: String = ["viewBox", "font-size", "stroke-linejoin"].into_iter().filter_map(keep).collect();
    // What stands between elements is not drawn, and ends of lines were a hundredth of the document.
    let line = |line: &str| if line.ends_with('>') { line.to_owned() } else { format!("{line}\n") };
    let body: String = body.lines().map(line).collect();
    format!(
        "<figure><svg role=\"img\" aria-label=\"{caption}\"{attributes}>{}<figcaption>{caption}</figcaption></figure>",
        body.trim_end()
    )
}

fn missing(why: &str, caption: &str) -> String {
    let caption = escaped(caption);
    format!("<figure><p class=\"missing\">{}</p><figcaption>{caption}</figcaption></figure>", escaped(why))
}
