//! The `figure` (or `figures`) of an experiment, checked against the columns that its table will have.

use serde_json::json;

use super::case::Case;
use super::columns::{Columns, Role};
use super::figure_spec::{
    AnimationSpec, Axis, AxisScale, AxisUnit, Band, Drawing, FigureSpec, Level, Only, Panel, PeakMarks, Strip,
};
use super::sweep::{NAME, is_name};
use crate::measure::Measure;
use crate::text::number::compact;
use crate::yaml::reader::{number, scalar};
use crate::yaml::word::{from_word, word_of};
use crate::yaml::{At, Findings, Keys, Span, Value, schema, worth};

/// What stands after the id in the name of the drawing of what is simulated; no figure has it.
pub(crate) const SCENE_DRAWING: &str = "scene";

/// Reads a figure; `columns` is `None` where the parts that make them were wrong themselves.
pub(super) struct FigureReader<'t> {
    pub findings: &'t Findings,
    pub columns: Option<&'t Columns>,
    /// The cases of the sweep, where they are known.
    pub cases: &'t [Case],
}

impl FigureReader<'_> {
    /// `figure: {…}` or `figures: [{…}, …]`.
    pub fn figures(&self, keys: &Keys<'_>) -> Option<Vec<FigureSpec>> {
        let figure = |at: At<'_>| at.named("figure", "A figure", |at| self.figure(at));
        let figures = keys.at_most_one(&[("figure", "A figure"), ("figures", "Several figures")], |key, at| {
            let figures = if key == "figure" { vec![figure(at)?] } else { at.list(figure)? };
            for (index, figure) in figures.iter().enumerate() {
                if figures[..index].iter().any(|other| other.name == figure.name) {
                    let name = if figure.name.is_empty() { "(none)" } else { &figure.name };
                    return at.report(
                        format!("two figures have the same name {name}"),
                        Some("give all but the first a `name` of its own".into()),
                    );
                }
            }
            Some(figures)
        });
        figures.map(Option::unwrap_or_default)
    }

    fn figure(&self, at: At<'_>) -> Option<FigureSpec> {
        let keys = at.keys("a figure")?;
        let name = keys.optional("name", "Name of the file after the id; none for the first", name);
        let caption = keys.required("caption", "One line under it", |at| at.text());
        let only = keys.optional("only", "The rows to draw", |at| self.only(at));
        let with =
            |drawing| Some(FigureSpec { name: name?.unwrap_or_default(), caption: caption?, only: only?, drawing });
        let map = keys.optional("map", "Colours over two columns", |at| self.map(at));
        if !matches!(map, Some(None)) {
            let misplaced = ["x", "y", "by", "band", "over_first", "markers", "panels", "guides", "peaks", "strip"]
                .map(|key| keys.get(key));
            keys.close()?;
            if let Some(at) = misplaced.into_iter().flatten().next() {
                return at.wrong("beside `map`, a figure has `name`, `caption` and `only` alone");
            }
            return with(Drawing::Map(map??));
        }
        let gaps = keys.optional("gaps", "The gaps of an optimised array as bars", |at| at.boolean());
        if gaps == Some(Some(true)) {
            keys.close()?;
            return with(Drawing::Gaps);
        }
        let slowed_down = "The motion of damper and particle from the trace, slowed down";
        let animation = keys.optional("animation", slowed_down, |at| self.animation(at));
        if !matches!(animation, Some(None)) {
            keys.close()?;
            return with(Drawing::Animation(animation??));
        }
        keys.rule(|| {
            json!({
                "if": {"anyOf": [{"required": ["map"]}, {"required": ["gaps"]}, {"required": ["animation"]}]},
                "then": {"propertyNames": {"enum": ["name", "caption", "only", "map", "gaps", "animation"]}},
                "else": {"anyOf": [{"required": ["panels"]}, {"required": ["x", "y"]}]},
            })
        });
        // Of several panels these may stand here.
        for key in ["x", "by", "band", "markers"] {
            keys.get(key);
        }
        let panels = keys.optional("panels", "Panels above each other", |at| {
            at.list(|at| {
                let own = at.keys("a panel")?;
                let panel = self.panel(&own, Some(&keys));
                own.rule(|| json!({"required": ["y"]}));
                own.close()?;
                panel
            })
        });
        let panels = match panels {
            Some(None) => self.panel(&keys, None).map(|panel| vec![panel]),
            Some(Some(panels)) => Some(panels),
            None => None,
        };
        keys.close()?;
        with(Drawing::Lines(panels?))
    }

    /// `{column: sweep, words: [point_1, point_2]}`.
    fn only(&self, at: At<'_>) -> Option<Only> {
        let keys = at.keys("rows to draw")?;
        let column = keys.required("column", "The column", |at| self.split(at));
        let words = keys.required("words", "The column's words that count", |at| at.one_or_more(|at| at.text()));
        keys.close()?;
        Some(Only { column: column?, words: words? })
    }

    /// `{by: gap_ratio}`; the time history has to be kept.
    fn animation(&self, at: At<'_>) -> Option<AnimationSpec> {
        let keys = at.keys("an animation")?;
        let by = keys.optional("by", "A row for each", |at| at.one_or_more(|at| self.split(at)));
        keys.close()?;
        self.column("particle_displacement", at.span(), |role| role == Role::History)?;
        Some(AnimationSpec { by: by?.unwrap_or_default() })
    }

    /// What a panel does not say itself it takes over from its figure.
    fn panel(&self, keys: &Keys<'_>, figure: Option<&Keys<'_>>) -> Option<Panel> {
        let x = match keys.inherited(figure, "x", "What runs along the x axis", |at| self.x_axis(at)) {
            Some(None) => keys.lacks("x"),
            x => x.flatten(),
        };
        let by = "Columns that split rows into lines";
        let by = keys.inherited(figure, "by", by, |at| at.one_or_more(|at| self.split(at)));
        let band = keys.inherited(figure, "band", BAND, read_band);
        let markers = keys.inherited(figure, "markers", "A mark at each point", |at| at.boolean());
        let y = match keys.optional("y", "What is drawn", |at| at.one_or_more(|at| self.axis(at))) {
            Some(None) => keys.lacks("y"),
            y => y.flatten(),
        };
        let over_first = keys.optional("over_first", "Each line over the first one", |at| at.boolean());
        let guides = keys.optional("guides", "Levels drawn across", |at| at.list(read_level));
        let peaks = keys.optional("peaks", "Peaks that are marked", read_peaks);
        let below = "What a strip below the frame shows along the x axis";
        let strip = keys.optional("strip", below, |at| self.strip(at));
        let ((x, x_role), y) = (x?, y?);
        let strip_at = keys.span_of("strip");
        if let (Some(Some(_)), Some(Role::History | Role::Scatter), Some(at)) = (strip, x_role, strip_at) {
            return self.findings.wrong(at, "a strip stands below numbers a row, not below a time history");
        }
        let clouds = y.iter().filter(|(_, role)| *role == Some(Role::Cloud)).count();
        if x_role == Some(Role::Cloud) {
            return self.findings.wrong(keys.span(), format!("`{}` holds a list a row: it stands under `y`", x.column));
        }
        if clouds > 0 && clouds < y.len() {
            return self.findings.wrong(keys.span(), "values of each cycle are points: they have a panel of their own");
        }
        if let (1.., Some(at)) = (clouds, keys.span_of("peaks").or(keys.span_of("over_first"))) {
            return self.findings.wrong(at, "values of each cycle are points, which no line joins");
        }
        for (axis, role) in &y {
            if let (Some(role), Some(x_role)) = (role, x_role)
                && role.is_drawn_as_a_list() != x_role.is_drawn_as_a_list()
            {
                return self.findings.wrong(
                    keys.span(),
                    format!("`{}` cannot be drawn against `{}`: one is a list a row", axis.column, x.column),
                );
            }
        }
        let y: Vec<Axis> = y.into_iter().map(|(axis, _)| axis).collect();
        let worth = y.first().and_then(|axis| axis.unit.as_ref()).map_or(1.0, |unit| unit.worth);
        let mut guides = guides?.unwrap_or_default();
        guides.iter_mut().for_each(|guide| guide.at *= worth);
        Some(Panel {
            x,
            y,
            by: by?.unwrap_or_default(),
            band: band?.unwrap_or(Band::None),
            over_first: over_first?.unwrap_or(false),
            guides,
            markers: markers?.unwrap_or(false),
            peaks: peaks?,
            strip: strip?,
            joined: self.columns.map(|columns| columns.joined).unwrap_or_default(),
        })
    }

    /// `motion`, which has to be measured.
    fn strip(&self, at: At<'_>) -> Option<Strip> {
        let strip = at.word::<Strip>("strip")?;
        let measured = self.columns.is_none_or(|columns| columns.role(&word_of(Measure::Motion)).is_some());
        if measured {
            return Some(strip);
        }
        at.report("the kind of motion is not measured in this experiment", Some("add `motion` to `measure`".into()))
    }

    /// A column's name, or `{column: …, scale: log, label: …, unit: mm, reach: [0, 1]}`.
    pub(super) fn axis(&self, at: At<'_>) -> Option<(Axis, Option<Role>)> {
        at.named("axis", "A column, or {column, scale, label, unit, reach}", |at| self.any_axis(at, false))
    }

    /// As [`FigureReader::axis`], of which a part may be drawn alone: `range: [170, 210]`.
    fn x_axis(&self, at: At<'_>) -> Option<(Axis, Option<Role>)> {
        at.named("x_axis", "A column, or {column, scale, label, unit, reach, range}", |at| self.any_axis(at, true))
    }

    /// The ends of what a sweep gives a column.
    fn reach_of(&self, column: &str) -> Option<[f64; 2]> {
        let parameter = from_word(column)?;
        let numbers =
            || self.cases.iter().filter_map(|case| case.number(parameter)).filter(|number| number.is_finite());
        let [low, high] = [numbers().reduce(f64::min)?, numbers().reduce(f64::max)?];
        Some([low, high])
    }

    fn any_axis(&self, at: At<'_>, may_be_a_part: bool) -> Option<(Axis, Option<Role>)> {
        let plain = |at: At<'_>| {
            let (column, span) = column_name(at)?;
            let role = self.column(&column, span, |role| role != Role::Label)?;
            Some((Axis::of(&column), role))
        };
        at.either(|value| matches!(value, Value::Mapping(_)), |at| self.long_axis(at, may_be_a_part), plain)
    }

    fn long_axis(&self, at: At<'_>, may_be_a_part: bool) -> Option<(Axis, Option<Role>)> {
        let keys = at.keys("an axis")?;
        let column = keys.required("column", "The column", column_name);
        let label = keys.optional("label", "Its label, in place of the column's own words", |at| at.text());
        let scale = keys.optional("scale", "Its scale", |at| at.word::<AxisScale>("scale"));
        let unit =
            keys.optional("unit", "The unit of its numbers and of those that stand here: mm, Hz", |at| at.text());
        let reach = keys.optional("reach", "From one number to a larger one, at least", read_reach);
        let part = "From one number to a larger one: only what lies between them is drawn";
        let range = keys.optional_where(may_be_a_part, "range", part, read_reach);
        let unit_at = keys.span_of("unit");
        let range_at = may_be_a_part.then(|| keys.span_of("range")).flatten();
        keys.close()?;
        let (column, span) = column?;
        let role = self.column(&column, span, |role| role != Role::Label)?;
        let unit = match (unit?, unit_at) {
            (Some(symbol), Some(unit_at)) => Some(self.unit(symbol, &column, unit_at)?),
            _ => None,
        };
        let worth = unit.as_ref().map_or(1.0, |unit| unit.worth);
        let to_column = |ends: Option<[f64; 2]>| ends.map(|ends| ends.map(|end| worth * end));
        let (reach, range) = (to_column(reach?), to_column(range?));
        let axis = Axis { column, label: label?, scale: scale?.unwrap_or_default(), reach, range, unit };
        let not_positive = |ends: &[f64; 2]| ends[0] <= 0.0;
        if axis.scale == AxisScale::Log && axis.reach.iter().chain(&axis.range).any(not_positive) {
            return at.wrong("a logarithmic axis reaches from a number above zero");
        }
        if let (Some([from, to]), Some(range_at), Some([low, high])) =
            (axis.range, range_at, self.reach_of(&axis.column))
            && (from > high || to < low)
        {
            let column = &axis.column;
            let unit =
                axis.unit.as_ref().map_or_else(|| Columns::unit(column).unwrap_or_default(), |unit| &unit.symbol);
            let [low, high] = [low, high].map(|end| compact(end / worth, 6));
            let help = format!("`{column}` goes from {low} to {} here", format!("{high} {unit}").trim_end());
            return at.report_at(range_at, format!("nothing of `{column}` lies in this range"), Some(help));
        }
        Some((axis, role))
    }

    /// A unit that the numbers of a column can be shown in.
    fn unit(&self, symbol: String, column: &str, at: Span) -> Option<AxisUnit> {
        let Some(of) = Columns::unit(column).filter(|of| !of.is_empty()) else {
            return self.findings.wrong(at, format!("the numbers of `{column}` have no unit that can be chosen"));
        };
        match worth(&symbol, of) {
            Ok(worth) => Some(AxisUnit { symbol, worth }),
            Err(error) => {
                let help = format!("`{column}` is in {of}; leave `unit` out, or write one of the same kind");
                self.findings.report(at, error.to_string(), Some(help))
            }
        }
    }

    /// A column that splits rows into lines.
    pub(super) fn split(&self, at: At<'_>) -> Option<String> {
        let (column, span) = column_name(at)?;
        self.column(&column, span, |role| matches!(role, Role::Number | Role::Label))?;
        Some(column)
    }

    #[expect(clippy::option_option, reason = "wrong, and not known because something else is wrong")]
    pub(super) fn column(&self, name: &str, span: Span, fits: impl Fn(Role) -> bool) -> Option<Option<Role>> {
        let Some(columns) = self.columns else { return Some(None) };
        match columns.role(name) {
            Some(role) if fits(role) => Some(Some(role)),
            Some(Role::Label) => self.findings.wrong(span, format!("`{name}` holds words: it cannot be an axis")),
            Some(_) => self
                .findings
                .wrong(span, format!("`{name}` holds a list a row; a number or a word a row is wanted here")),
            None if Columns::is_history(name) => self.findings.report(
                span,
                format!("`{name}` is a time history, and this experiment keeps none"),
                Some("add `trace: {from: … cycles, to: … cycles, samples_per_cycle: …}`".into()),
            ),
            None => columns.unknown("the table of this experiment", name, span, self.findings),
        }
    }
}

/// What a band shows.
const BAND: &str = "spread: standard deviation of the ensemble; seeds: least to largest of searches that differ in their seed; \
     stacked: each line stands on the one before, and the space between is filled";

fn read_band(at: At<'_>) -> Option<Band> {
    at.choose("a band", &["spread", "none", "seeds", "stacked"].map(|word| (word, "")), |choice| {
        choice.bare()?;
        Some(match choice.name() {
            "spread" => Band::Spread,
            "seeds" => Band::Seeds,
            "stacked" => Band::Stacked,
            _ => Band::None,
        })
    })
}

fn name(at: At<'_>) -> Option<String> {
    at.form(
        |node, findings| {
            let name = scalar(node, findings)?;
            if name == SCENE_DRAWING {
                let help = Some("give the figure another name".to_owned());
                return findings.report(node.span, format!("`{name}` names the drawing of the scene"), help);
            }
            if is_name(name) {
                return Some(name.into());
            }
            findings.wrong(node.span, format!("`{name}` cannot name a figure: use letters, digits, `-` and `_`"))
        },
        |it| json!({"description": it.about(), "type": "string", "pattern": NAME, "not": {"const": SCENE_DRAWING}}),
    )
}

/// The name of a column, which need not be one of this experiment.
pub(super) fn column_name(at: At<'_>) -> Option<(String, Span)> {
    at.named("column", "A column of the table", |at| {
        at.form(|node, findings| Some((scalar(node, findings)?.to_owned(), node.span)), |_| Columns::offered())
    })
}

fn read_reach(at: At<'_>) -> Option<[f64; 2]> {
    match at.pair(|at| at.number())?.as_slice() {
        &[from, to] if from < to => Some([from, to]),
        _ => at.wrong("an axis reaches from one number to a larger one: `reach: [0, 1]`"),
    }
}

fn read_level(at: At<'_>) -> Option<Level> {
    let keys = at.keys("a guide")?;
    let height = keys.required("at", "Where", |at| at.number());
    let label = keys.optional("label", "Its label", |at| at.text());
    keys.close()?;
    Some(Level { at: height?, label: label?.unwrap_or_default() })
}

fn read_peaks(at: At<'_>) -> Option<PeakMarks> {
    let keys = at.keys("peaks")?;
    let prominence = keys.optional("prominence", "How far one stands out, as a share of the y axis", |at| {
        at.form(
            |node, findings| match number(node, findings)? {
                share if share > 0.0 && share < 1.0 => Some(share),
                _ => findings.wrong(node.span, "a prominence is a share of the y axis, between 0 and 1"),
            },
            |it| schema::inner_share(it.about()),
        )
    });
    let most = keys.optional("most", "Peaks at most", |at| at.count("peaks", 50));
    keys.close()?;
    Some(PeakMarks { prominence: prominence?.unwrap_or(0.05), most: most?.unwrap_or(8) })
}
