//! The limit of a row, `{events: 1e8, time: 10 min}`, and the same on a command line, `1e8 events, 10 min`.

use std::str::FromStr;
use std::time::Duration;

use serde_json::json;

use crate::dynamics::Limit;
use crate::yaml::reader::scalar;
use crate::yaml::schema::{self, NUMBER, PREFIX};
use crate::yaml::{At, Dimension, Findings, Node, parse_number, parse_quantity};

/// Longest time that can be asked for: a year.
const LONGEST: f64 = 31_557_600.0;

/// Most events that can be asked for; whole numbers of this size are exact.
const MOST_EVENTS: f64 = 1e15;

/// What an editor says of the limit of events.
const EVENTS: &str =
    "Events of a row, or of each point that it takes a mean over or looks for a maximum among; 1e8 unless stated";

/// A limit of which parts may be left as they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RowLimit {
    /// Events of a row, or of each point that it takes a mean over or looks for a maximum among.
    pub events: Option<u64>,
    /// Processor time of a row.
    pub time: Option<Duration>,
}

/// A text that is no limit.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no limit of a row; write for example `1e8 events`, `10 min`, or both with a comma between them")]
pub struct NoLimit(String);

impl RowLimit {
    /// This limit, and what it leaves open as in `usual`.
    #[must_use]
    pub fn over(self, usual: Limit) -> Limit {
        Limit { events: self.events.unwrap_or(usual.events), time: self.time.unwrap_or(usual.time) }
    }
}

impl FromStr for RowLimit {
    type Err = NoLimit;

    fn from_str(text: &str) -> Result<Self, NoLimit> {
        let mut limit = Self::default();
        for part in text.split(',').map(str::trim) {
            // Beside times a number alone would leave open what it counts.
            let counted = part.strip_suffix("events").and_then(events);
            let taken = match (counted, time(part)) {
                (Some(events), _) => limit.events.replace(events).is_some(),
                (_, Some(time)) => limit.time.replace(time).is_some(),
                _ => true,
            };
            if taken {
                return Err(NoLimit(text.into()));
            }
        }
        Ok(limit)
    }
}

/// Reads the mapping of an experiment.
pub(super) fn read_limit(at: At<'_>) -> Option<Limit> {
    let keys = at.keys("a limit")?;
    let events = keys.optional("events", EVENTS, |at| {
        let read = |node: &Node, findings: &Findings| {
            part(node, events, "a whole number of events from 1 to 1e15", "1e8", findings)
        };
        at.form(read, |it| schema::between(it.about(), 1.0, MOST_EVENTS))
    });
    let time = keys.optional("time", "Processor time of a row; 10 min unless stated", |at| {
        let read =
            |node: &Node, findings: &Findings| part(node, time, "a time up to a year", "10 min, 30 s or 2 h", findings);
        let pattern = format!(r"^\s*{NUMBER}\s*(h|min|{PREFIX}s)\s*$");
        at.form(
            read,
            |it| json!({"description": it.about(), "type": "string", "pattern": pattern, "examples": ["10 min"]}),
        )
    });
    keys.close()?;
    Some(RowLimit { events: events?, time: time? }.over(Limit::default()))
}

fn part<T>(node: &Node, read: impl Fn(&str) -> Option<T>, what: &str, example: &str, findings: &Findings) -> Option<T> {
    let text = scalar(node, findings)?;
    let help = || Some(format!("write for example {example}"));
    read(text).or_else(|| findings.report(node.span, format!("`{text}` is not {what}"), help()))
}

/// `1e8`, `100000`, with or without its noun.
fn events(text: &str) -> Option<u64> {
    let digits = text.trim().trim_end_matches("events").trim();
    let number = parse_number(digits).ok()?;
    ((1.0..=MOST_EVENTS).contains(&number) && number.fract() == 0.0).then_some(number as u64)
}

/// `10 min`, `2 h`, or seconds with any prefix.
fn time(text: &str) -> Option<Duration> {
    let text = text.trim();
    let in_units = |unit: &str, seconds: f64| {
        let number = parse_number(text.strip_suffix(unit)?.trim()).ok()?;
        Some(number * seconds)
    };
    let seconds = in_units("min", 60.0)
        .or_else(|| in_units("h", 3600.0))
        .or_else(|| parse_quantity(text, Dimension::Time).ok())?;
    (seconds > 0.0 && seconds <= LONGEST).then(|| Duration::from_secs_f64(seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_written_in_events_or_in_time_or_in_both() {
        let limit = |text: &str| text.parse::<RowLimit>();
        let time = |seconds| Some(Duration::from_secs(seconds));
        assert_eq!(limit("1e7 events"), Ok(RowLimit { events: Some(10_000_000), time: None }));
        assert_eq!(limit("30 s"), Ok(RowLimit { events: None, time: time(30) }));
        assert_eq!(limit("5min, 1000 events"), Ok(RowLimit { events: Some(1000), time: time(300) }));
        assert_eq!(limit("2 h"), Ok(RowLimit { events: None, time: time(7200) }));
        for wrong in
            ["", "0", "5", "1 min, 5", "-1 s", "0 s", "1.5 events", "1e300 s", "soon", "1 s, 2 s", "nan", "inf h"]
        {
            assert!(limit(wrong).is_err(), "{wrong}");
        }
    }
}
