//! Where in a file a part of its meaning is written.

use super::recipe::{Part, assumption_of};
use crate::yaml::{Findings, Node, Value, read_tree};

/// The line, counted from 1, on which the leaf at `path` of an experiment's or the assumptions' meaning is written, or the
/// part that it belongs to if it has no line of its own. `None` if the text is no YAML, or nothing in it answers to the path.
#[must_use]
pub fn line_of(text: &str, path: &[String]) -> Option<usize> {
    let root = read_tree(text, &Findings::default())?;
    let mut node = &root;
    let mut place = None;
    for key in path {
        if let (Value::Sequence(items), Ok(index)) = (&node.value, key.parse::<usize>()) {
            if let Some(item) = items.get(index) {
                (node, place) = (item, Some(item.span.start));
            }
        } else if let Some((below, at)) = find(node, written(key)) {
            (node, place) = (below, Some(at));
        }
    }
    // Of an assumption the value, not its name.
    if let (Some(_), Value::Mapping(_)) = (place, &node.value)
        && let Some((_, at)) = own(node, "value")
    {
        place = Some(at);
    }
    Some(text.get(..place?)?.matches('\n').count() + 1)
}

/// What is written of a part of the scene.
pub(super) fn part_of(scene: &Node, part: Part) -> Option<&Node> {
    match part {
        Part::Structure => exactly(scene, "structure"),
        Part::Excitation => exactly(scene, "excitation"),
        Part::Observe => exactly(scene, "observe"),
        Part::Start => exactly(scene, "start"),
        Part::Damper(index) => match &exactly(scene, "dampers")?.value {
            Value::Sequence(dampers) => dampers.get(index),
            _ => None,
        },
    }
}

/// The value under this very key, at any depth.
pub(super) fn exactly<'n>(node: &'n Node, key: &str) -> Option<&'n Node> {
    let Value::Mapping(entries) = &node.value else { return None };
    let own = entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node);
    own.or_else(|| entries.iter().find_map(|entry| exactly(&entry.node, key)))
}

/// What a part of the meaning is called in YAML.
fn written(key: &str) -> &str {
    match key {
        "recipe" => "scene",
        "settings" => "run",
        "cases" | "swept" | "refined" | "continued" => "sweep",
        "measures" => "measure",
        // `stop_length=0.05` stands for an end of its range.
        _ => assumption_of(key),
    }
}

/// The value under a key, and where the key stands; below it or, where the meaning has a level that the text has not, further
/// below.
fn find<'n>(node: &'n Node, key: &str) -> Option<(&'n Node, usize)> {
    own(node, key).or_else(|| match &node.value {
        Value::Mapping(entries) => entries.iter().find_map(|entry| find(&entry.node, key)),
        _ => None,
    })
}

fn own<'n>(node: &'n Node, key: &str) -> Option<(&'n Node, usize)> {
    let Value::Mapping(entries) = &node.value else { return None };
    let exact = entries.iter().find(|entry| entry.key == key);
    // `mass: {ratio: …}` is written `mass_ratio: …`.
    let joined = || entries.iter().find(|entry| entry.key.strip_prefix(key).is_some_and(|rest| rest.starts_with('_')));
    exact.or_else(joined).map(|entry| (&entry.node, entry.key_span.start))
}
