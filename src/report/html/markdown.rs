//! Markdown to HTML. Of the HTML in it only the few forms that the pages themselves write stay markup; all else is text.

use pulldown_cmark::{Event, HeadingLevel, LinkType, Options, Parser, Tag, TagEnd, html::push_html};

use super::super::markdown::html as escaped;
use super::figures::Figures;
use super::links::{Links, joined, marked};

/// Where a text stands.
pub(super) struct Here<'a> {
    /// Its file below `reports/`.
    pub page: &'a str,
    /// Its section in the document.
    pub section: &'a str,
    pub links: &'a Links,
    pub figures: &'a Figures,
}

/// A page.
pub(super) fn render(text: &str, here: &Here<'_>) -> String {
    let mut events = Vec::new();
    let all: Vec<Event<'_>> = Parser::new_ext(text, Options::ENABLE_TABLES).collect();
    let mut source = all.iter().cloned().enumerate();
    // Whether the links that are open lead somewhere.
    let mut open = Vec::new();
    while let Some((at, event)) = source.next() {
        match event {
            Event::Html(text) | Event::InlineHtml(text) => events.push(Event::Html(safe(&text, here.section).into())),
            Event::Start(Tag::Link { dest_url, title, id, .. }) => {
                let link = here.links.resolve(here.page, &dest_url);
                open.push(link.is_some());
                let tag = |url: String| Tag::Link { link_type: LinkType::Inline, dest_url: url.into(), title, id };
                events.extend(link.map(|url| Event::Start(tag(url))));
            }
            Event::End(TagEnd::Link) => {
                if open.pop() == Some(true) {
                    events.push(Event::End(TagEnd::Link));
                }
            }
            Event::Start(Tag::Image { dest_url, .. }) => {
                let mut caption = String::new();
                for (_, event) in source.by_ref() {
                    match event {
                        Event::End(TagEnd::Image) => break,
                        Event::Text(text) | Event::Code(text) => caption += &text,
                        _ => {}
                    }
                }
                events.push(Event::Html(here.figures.get(&joined(here.page, &dest_url), &caption).into()));
            }
            Event::Start(Tag::Heading { level, classes, attrs, .. }) => {
                let inner = all[at..].iter().take_while(|event| !matches!(event, Event::End(TagEnd::Heading(_))));
                let id = (level != HeadingLevel::H1).then(|| marked(here.section, &slug(inner)).into());
                events.push(Event::Start(Tag::Heading { level, id, classes, attrs }));
            }
            Event::Start(Tag::Table(columns)) => {
                // Wider than a phone: it scrolls by itself, with the keyboard too.
                let scroll = "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Table\">";
                events.push(Event::Html(scroll.into()));
                events.push(Event::Start(Tag::Table(columns)));
            }
            Event::End(TagEnd::Table) => events.extend([Event::End(TagEnd::Table), Event::Html("</div>".into())]),
            other => events.push(other),
        }
    }
    let mut html = String::new();
    push_html(&mut html, events.into_iter());
    // A figure stands in a paragraph of its own.
    html.replace("<p><figure", "<figure").replace("</figure></p>", "</figure>").replace("<th></th>", "<td></td>")
}

/// A text without paragraphs, for a cell.
pub(super) fn inline(text: &str, here: &Here<'_>) -> String {
    let html = render(text, here);
    html.trim().trim_start_matches("<p>").trim_end_matches("</p>").replace("</p>\n<p>", "<br>")
}

/// A heading as the target of a link, as GitHub makes it.
fn slug<'a>(inner: impl Iterator<Item = &'a Event<'a>>) -> String {
    let text = inner.filter_map(|event| match event {
        Event::Text(text) | Event::Code(text) => Some(text),
        _ => None,
    });
    let letters = text.flat_map(|text| text.chars());
    letters
        .filter_map(|letter| match letter {
            ' ' => Some('-'),
            letter if letter.is_alphanumeric() || matches!(letter, '-' | '_') => Some(letter.to_ascii_lowercase()),
            _ => None,
        })
        .collect()
}

/// The tags that pages write.
const TAGS: [&str; 8] = ["<details>", "<details open>", "</details>", "<summary>", "</summary>", "<b>", "</b>", "</a>"];

/// HTML of which all but known tags is text.
fn safe(html: &str, section: &str) -> String {
    let mut safe = String::with_capacity(html.len());
    let mut rest = html;
    while let Some(start) = rest.find('<') {
        safe += &escaped(&rest[..start]);
        rest = &rest[start..];
        if let Some(tag) = TAGS.iter().find(|tag| rest.starts_with(**tag)) {
            safe += tag;
            rest = &rest[tag.len()..];
        } else if let Some((mark, after)) = mark(rest) {
            safe += &format!("<a id=\"{}\">", marked(section, mark));
            rest = after;
        } else {
            safe += "&lt;";
            rest = &rest[1..];
        }
    }
    safe + &escaped(rest)
}

/// The name in `<a id="name">`, and what follows.
fn mark(text: &str) -> Option<(&str, &str)> {
    let (name, rest) = text.strip_prefix("<a id=\"")?.split_once("\">")?;
    let plain = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '-' | '_');
    (!name.is_empty() && name.chars().all(plain)).then_some((name, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rendered(text: &str) -> String {
        let (links, figures) = (Links::new(&[]), Figures::default());
        render(text, &Here { page: "ch3/ch3-a.md", section: "ch3-a", links: &links, figures: &figures })
    }

    #[test]
    fn nothing_that_a_study_says_becomes_a_script() {
        for text in [
            "<script>alert(1)</script>",
            "# A <script>alert(1)</script> title",
            "a <img src=x onerror=alert(1)> b",
            "<details ontoggle=alert(1)>",
            "<a id=\"x\" onclick=\"alert(1)\"></a>",
            "<svg/onload=alert(1)>",
            "| a |\n| - |\n| <b onmouseover=alert(1)>x</b> |\n",
        ] {
            let html = rendered(text);
            for tag in ["<script", "<img", "<details ", "onclick=\"", "<svg", "<b "] {
                assert!(!html.contains(tag), "{text} gives {html}");
            }
        }
        assert_eq!(rendered("[a](javascript:alert(1))"), "<p>a</p>\n");
        assert_eq!(rendered("# [a](javascript:alert(1))"), "<h1>a</h1>\n");
        assert_eq!(rendered("[a](file:///etc/passwd)"), "<p>a</p>\n");
    }

    #[test]
    fn links_between_files_lead_to_sections_and_entries() {
        let html =
            rendered("[a](../README.md#how-to-read) [b](#entry-maximum) [c](../accuracy.md) [d](https://example.org)");
        assert_eq!(html, "<p><a href=\"#study/how-to-read\">a</a> b c <a href=\"https://example.org\">d</a></p>\n");
        assert_eq!(rendered("<a id=\"entry-maximum\"></a>x").trim(), "<p><a id=\"ch3-a/maximum\"></a>x</p>");
        assert_eq!(rendered("## How to read, ψ").trim(), "<h2 id=\"ch3-a/how-to-read-ψ\">How to read, ψ</h2>");
    }
}
