//! Pages that are handed on without some of the files that they link to.

use std::ops::Range;

use pulldown_cmark::{Event, Options, Parser, Tag};

use super::html::joined;

/// The Markdown of the file `from`, in which links to files that are not there are plain text.
pub(super) fn without_dead_links(markdown: &str, from: &str, is_there: impl Fn(&str) -> bool + Copy) -> String {
    let is_dead = |link: &str| {
        let file = link.split_once('#').map_or(link, |(file, _)| file);
        !file.is_empty() && !file.contains(':') && !is_there(&joined(from, file))
    };
    let dead = |(event, place): (Event<'_>, Range<usize>)| match event {
        Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) if is_dead(&dest_url) => Some(place),
        _ => None,
    };
    let (mut text, mut end) = (String::new(), 0);
    for place in Parser::new_ext(markdown, Options::ENABLE_TABLES).into_offset_iter().filter_map(dead) {
        let written = &markdown[place.clone()];
        // What lies within a link that has gone is gone over with it.
        let (Some(open), Some(close), true) = (written.find('['), written.rfind("]("), place.start >= end) else {
            continue;
        };
        text += &markdown[end..place.start];
        text += &without_dead_links(&written[open + 1..close], from, is_there);
        end = place.end;
    }
    text + &markdown[end..]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_to_a_file_that_is_not_there_becomes_its_words() {
        let there = |name: &str| ["reports/ch3/a.md", "reports/ch3/a.png"].contains(&name);
        for (before, after) in [
            ("[Index](../README.md) and [a](a.md#x).", "Index and [a](a.md#x)."),
            ("[![A figure](a.png)](../all.md)", "![A figure](a.png)"),
            (
                "| [g](../assumptions.md#g) |\n| --- |\n| [w](https://w3.org) |",
                "| g |\n| --- |\n| [w](https://w3.org) |",
            ),
            ("[here](#there)", "[here](#there)"),
        ] {
            assert_eq!(without_dead_links(before, "reports/ch3/a.md", there), after);
        }
    }
}
