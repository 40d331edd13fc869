//! The `figure` (or `figures`) of an experiment, checked against the columns that its table will have.

use super::columns::{Columns, Role};
use super::definition::{
    AnimationSpec, Axis, AxisScale, Band, Drawing, FigureSpec, Level, Only, Panel, PeakMarks, Strip,
};
use super::diagnostic::{Findings, Span};
use super::reader::{Choice, Fields, boolean, count, list, number, one_or_more, scalar, text, unknown, word};
use super::sweep::is_name;
use super::word::word_of;
use super::yaml::{Node, Value};
use crate::measure::Measure;

/// Reads a figure; `columns` is `None` where the parts that make them were wrong themselves.
pub(super) struct FigureReader<'t> {
    pub findings: &'t Findings,
    pub columns: Option<&'t Columns>,
}

/// What panels take over from their figure.
struct Shared<'t> {
    x: Option<&'t Node>,
    by: Option<&'t Node>,
    band: Option<&'t Node>,
    markers: Option<&'t Node>,
}

impl<'t> FigureReader<'t> {
    /// `figure: {…}` or `figures: [{…}, …]`.
    pub fn figures(&self, fields: &Fields<'t>) -> Option<Vec<FigureSpec>> {
        let Some((key, node)) = fields.at_most_one(&["figure", "figures"])? else {
            return Some(Vec::new());
        };
        let figures = match key {
            "figure" => vec![self.figure(node)?],
            _ => list(node, self.findings, |node| self.figure(node))?,
        };
        for (index, figure) in figures.iter().enumerate() {
            if figures[..index].iter().any(|other| other.name == figure.name) {
                let name = if figure.name.is_empty() { "(none)" } else { &figure.name };
                return self.findings.report(
                    node.span,
                    format!("two figures have the same name {name}"),
                    Some("give all but the first a `name` of its own".into()),
                );
            }
        }
        Some(figures)
    }

    fn figure(&self, node: &'t Node) -> Option<FigureSpec> {
        let fields = Fields::open(node, "a figure", self.findings)?;
        let name = fields.optional("name", |node| self.name(node));
        let caption = fields.required("caption", |node| text(node, self.findings));
        let only = fields.optional("only", |node| self.only(node));
        if let Some(node) = fields.get("map") {
            let map = self.map(node);
            let misplaced = ["x", "y", "by", "band", "over_first", "markers", "panels", "guides", "peaks", "strip"]
                .map(|key| fields.get(key));
            fields.close()?;
            if let Some(node) = misplaced.into_iter().flatten().next() {
                return self.findings.wrong(node.span, "beside `map`, a figure has `name`, `caption` and `only` alone");
            }
            return Some(FigureSpec {
                name: name?.unwrap_or_default(),
                caption: caption?,
                only: only?,
                drawing: Drawing::Map(map?),
            });
        }
        if fields.get("gaps").is_some_and(|node| boolean(node, self.findings) == Some(true)) {
            fields.close()?;
            return Some(FigureSpec {
                name: name?.unwrap_or_default(),
                caption: caption?,
                only: only?,
                drawing: Drawing::Gaps,
            });
        }
        if let Some(node) = fields.get("animation") {
            let animation = self.animation(node);
            fields.close()?;
            return Some(FigureSpec {
                name: name?.unwrap_or_default(),
                caption: caption?,
                only: only?,
                drawing: Drawing::Animation(animation?),
            });
        }
        let shared = Shared {
            x: fields.get("x"),
            by: fields.get("by"),
            band: fields.get("band"),
            markers: fields.get("markers"),
        };
        let panels = match fields.get("panels") {
            Some(node) => list(node, self.findings, |node| {
                let fields = Fields::open(node, "a panel", self.findings)?;
                let panel = self.panel(&fields, &shared);
                fields.close()?;
                panel
            }),
            None => self.panel(&fields, &shared).map(|panel| vec![panel]),
        };
        fields.close()?;
        Some(FigureSpec {
            name: name?.unwrap_or_default(),
            caption: caption?,
            only: only?,
            drawing: Drawing::Lines(panels?),
        })
    }

    /// `{column: sweep, words: [point_1, point_2]}`.
    fn only(&self, node: &'t Node) -> Option<Only> {
        let fields = Fields::open(node, "rows to draw", self.findings)?;
        let column = fields.required("column", |node| self.split(node));
        let words = fields.required("words", |node| one_or_more(node, self.findings, |node| text(node, self.findings)));
        fields.close()?;
        Some(Only { column: column?, words: words? })
    }

    /// `{by: gap_ratio}`; the time history has to be kept.
    fn animation(&self, node: &'t Node) -> Option<AnimationSpec> {
        let fields = Fields::open(node, "an animation", self.findings)?;
        let by = fields.optional("by", |node| one_or_more(node, self.findings, |node| self.split(node)));
        fields.close()?;
        self.column("particle_displacement", node.span, |role| role == Role::History)?;
        Some(AnimationSpec { by: by?.unwrap_or_default() })
    }

    fn name(&self, node: &Node) -> Option<String> {
        let name = scalar(node, self.findings)?;
        if is_name(name) {
            return Some(name.into());
        }
        self.findings.wrong(node.span, format!("`{name}` cannot name a figure: use letters, digits, `-` and `_`"))
    }

    fn panel(&self, fields: &Fields<'t>, shared: &Shared<'t>) -> Option<Panel> {
        let own = |key, shared: Option<&'t Node>| fields.get(key).or(shared);
        let (x, by) = (own("x", shared.x), own("by", shared.by));
        let (band, markers) = (own("band", shared.band), own("markers", shared.markers));
        let x = match x {
            Some(node) => self.axis(node),
            None => fields.required("x", |node| self.axis(node)),
        };
        let y = fields.required("y", |node| one_or_more(node, self.findings, |node| self.axis(node)));
        let by = by.map_or(Some(Vec::new()), |node| one_or_more(node, self.findings, |node| self.split(node)));
        let band = band.map_or(Some(Band::None), |node| {
            let word = Choice::read(node, "a band", &["spread", "none", "seeds", "stacked"], self.findings)?
                .bare(self.findings)?;
            Some(match word {
                "spread" => Band::Spread,
                "seeds" => Band::Seeds,
                "stacked" => Band::Stacked,
                _ => Band::None,
            })
        });
        let over_first = fields.optional("over_first", |node| boolean(node, self.findings));
        let guides = fields.optional("guides", |node| list(node, self.findings, |node| self.level(node)));
        let markers = markers.map_or(Some(false), |node| boolean(node, self.findings));
        let peaks = fields.optional("peaks", |node| self.peaks(node));
        let strip = fields.optional("strip", |node| self.strip(node));
        let ((x, x_role), y) = (x?, y?);
        if let (Some(Some(_)), Some(Role::History | Role::Scatter), Some(node)) = (strip, x_role, fields.get("strip")) {
            return self.findings.wrong(node.span, "a strip stands below numbers a row, not below a time history");
        }
        let clouds = y.iter().filter(|(_, role)| *role == Some(Role::Cloud)).count();
        if x_role == Some(Role::Cloud) {
            return self
                .findings
                .wrong(fields.span(), format!("`{}` holds a list a row: it stands under `y`", x.column));
        }
        if clouds > 0 && clouds < y.len() {
            return self
                .findings
                .wrong(fields.span(), "values of each cycle are points: they have a panel of their own");
        }
        if let (1.., Some(node)) = (clouds, fields.get("peaks").or(fields.get("over_first"))) {
            return self.findings.wrong(node.span, "values of each cycle are points, which no line joins");
        }
        for (axis, role) in &y {
            if let (Some(role), Some(x_role)) = (role, x_role)
                && role.is_drawn_as_a_list() != x_role.is_drawn_as_a_list()
            {
                return self.findings.wrong(
                    fields.span(),
                    format!("`{}` cannot be drawn against `{}`: one is a list a row", axis.column, x.column),
                );
            }
        }
        let y = y.into_iter().map(|(axis, _)| axis).collect();
        Some(Panel {
            x,
            y,
            by: by?,
            band: band?,
            over_first: over_first?.unwrap_or(false),
            guides: guides?.unwrap_or_default(),
            markers: markers?,
            peaks: peaks?,
            strip: strip?,
            joined: self.columns.map(|columns| columns.joined).unwrap_or_default(),
        })
    }

    /// `motion`, which has to be measured.
    fn strip(&self, node: &'t Node) -> Option<Strip> {
        let strip = word::<Strip>(node, "strip", self.findings)?;
        let measured = self.columns.is_none_or(|columns| columns.role(&word_of(Measure::Motion)).is_some());
        if measured {
            return Some(strip);
        }
        self.findings.report(
            node.span,
            "the kind of motion is not measured in this experiment",
            Some("add `motion` to `measure`".into()),
        )
    }

    fn peaks(&self, node: &'t Node) -> Option<PeakMarks> {
        let fields = Fields::open(node, "peaks", self.findings)?;
        let prominence = fields.optional("prominence", |node| {
            let share = number(node, self.findings)?;
            if share > 0.0 && share < 1.0 {
                Some(share)
            } else {
                self.findings.wrong(node.span, "a prominence is a share of the y axis, between 0 and 1")
            }
        });
        let most = fields.optional("most", |node| count(node, "peaks", 50, self.findings));
        fields.close()?;
        Some(PeakMarks { prominence: prominence?.unwrap_or(0.05), most: most?.unwrap_or(8) })
    }

    /// A column's name, or `{column: …, scale: log, label: …, reach: [0, 1]}`.
    pub(super) fn axis(&self, node: &'t Node) -> Option<(Axis, Option<Role>)> {
        if !matches!(node.value, Value::Mapping(_)) {
            let column = scalar(node, self.findings)?;
            let role = self.column(column, node.span, |role| role != Role::Label)?;
            return Some((Axis { column: column.into(), label: None, scale: AxisScale::Linear, reach: None }, role));
        }
        let fields = Fields::open(node, "an axis", self.findings)?;
        let fields_span = fields.span();
        let column = fields.required("column", |node| Some((scalar(node, self.findings)?, node.span)));
        let label = fields.optional("label", |node| text(node, self.findings));
        let scale = fields.optional("scale", |node| word::<AxisScale>(node, "scale", self.findings));
        let reach = fields.optional("reach", |node| self.reach(node));
        fields.close()?;
        let (column, span) = column?;
        let role = self.column(column, span, |role| role != Role::Label)?;
        let axis = Axis { column: column.into(), label: label?, scale: scale?.unwrap_or_default(), reach: reach? };
        if let (AxisScale::Log, Some([from, _])) = (axis.scale, axis.reach)
            && from <= 0.0
        {
            return self.findings.wrong(fields_span, "a logarithmic axis reaches from a number above zero");
        }
        Some((axis, role))
    }

    fn reach(&self, node: &'t Node) -> Option<[f64; 2]> {
        match list(node, self.findings, |node| number(node, self.findings))?.as_slice() {
            &[from, to] if from < to => Some([from, to]),
            _ => self.findings.wrong(node.span, "an axis reaches from one number to a larger one: `reach: [0, 1]`"),
        }
    }

    /// A column that splits rows into lines.
    pub(super) fn split(&self, node: &Node) -> Option<String> {
        let column = scalar(node, self.findings)?;
        self.column(column, node.span, |role| matches!(role, Role::Number | Role::Label))?;
        Some(column.into())
    }

    fn level(&self, node: &Node) -> Option<Level> {
        let fields = Fields::open(node, "a guide", self.findings)?;
        let at = fields.required("at", |node| number(node, self.findings));
        let label = fields.optional("label", |node| text(node, self.findings));
        fields.close()?;
        Some(Level { at: at?, label: label?.unwrap_or_default() })
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
            None => unknown(self.findings, span, "the table of this experiment", "column", name, &columns.names()),
        }
    }
}
