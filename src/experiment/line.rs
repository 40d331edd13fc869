//! Where in a file a part of its meaning is written.

use super::assumption_sheet::assumption_of;
use super::diagnostic::{Findings, Span};
use super::recipe::Part;
use super::yaml::{Node, Value, read_tree};

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

/// Where a part of the scene is written, or all of it: the value under the first of `keys` that is there, or else the part.
pub(super) fn place_in(scene: &Node, part: Option<Part>, keys: &[&str]) -> Option<Span> {
    let Value::Mapping(entries) = &scene.value else { return None };
    let below = |key: &str| entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node);
    let part = match part {
        None => scene,
        Some(Part::Structure) => below("structure")?,
        Some(Part::Excitation) => below("excitation")?,
        Some(Part::Observe) => below("observe")?,
        Some(Part::Start) => below("start")?,
        Some(Part::Damper(index)) => match &below("dampers")?.value {
            Value::Sequence(dampers) => dampers.get(index)?,
            _ => return None,
        },
    };
    let value = keys.iter().find_map(|key| exactly(part, key));
    Some(value.unwrap_or(part).span)
}

/// The value under this very key, at any depth.
fn exactly<'n>(node: &'n Node, key: &str) -> Option<&'n Node> {
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
