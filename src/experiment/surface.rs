//! What a particle lands on: rigid and resilient surfaces, limit stops, soft walls.

use super::assumption_reader::read_curve;
use super::recipe::{
    ContactDampingConstant, ContactDampingRatio, ContactDampingRecipe, FloorStiffness, Given, Parameter, Quantity,
    Slot, StiffnessRecipe, StopRecipe, SurfaceRecipe, Takes, WallRecipe,
};
use super::scene_reader::SceneReader;
use crate::scene::Kind;
use crate::yaml::{At, Dimension, Keys};

const RESTITUTION: &str = "Coefficient of restitution, 0 to 1";

impl SceneReader<'_> {
    pub(super) fn surface(&self, at: At<'_>, kind: &'static Kind) -> Option<SurfaceRecipe> {
        let forms = [("rigid", "A rigid surface"), ("resilient", "A resilient surface")];
        at.named("surface", "A surface that the particle lands on", |at| {
            at.choose("a surface", &forms, |choice| {
                if choice.name() == "resilient" {
                    return self.resilient(choice.keys("a resilient surface")?, kind);
                }
                let keys = choice.keys("a rigid surface")?;
                let restitution =
                    keys.required("restitution", RESTITUTION, |at| self.given(at, Takes::ratio(), restitution));
                keys.close()?;
                Some(SurfaceRecipe::Rigid { restitution: restitution? })
            })
        })
    }

    fn resilient(&self, keys: Keys<'_>, kind: &'static Kind) -> Option<SurfaceRecipe> {
        let stiffnesses = [
            ("stiffness_ratio", "kf/ks: stiffness over that of the structure"),
            ("stiffness", "Stiffness, or what it is tuned to"),
        ];
        let stiffness = keys.exactly_one(&stiffnesses, |key, at| match key {
            "stiffness" => self.stiffness(at, kind).map(StiffnessRecipe::By),
            _ => self
                .slot(at, Slot::StiffnessRatio, kind, |at| self.swept_ratio(at, Parameter::FloorStiffnessRatio))
                .map(StiffnessRecipe::Ratio),
        });
        let untuned = Slot::UntunedFrequencyRatio;
        let untuned_ratio = keys
            .optional("untuned_frequency_ratio", untuned.about(), |at| self.slot(at, untuned, kind, |at| at.ratio()));
        let dampings = [("damping_ratio", "Damping ratio under the particle"), ("damping", "Damping")];
        let damping = keys.exactly_one(&dampings, |key, at| match key {
            "damping" if at.is_word("equivalent_viscous") => {
                Some(ContactDampingRecipe::Ratio(Given::Stated(ContactDampingRatio::EquivalentViscous)))
            }
            "damping" => {
                let takes =
                    Takes { quantity: Some(Quantity::Of(Dimension::Damping)), readings: &["equivalent_viscous"] };
                let constant = |at: At<'_>| at.quantity(Dimension::Damping).map(ContactDampingConstant::Constant);
                self.given(at, takes, constant).map(ContactDampingRecipe::Damping)
            }
            _ => self
                .slot(at, Slot::DampingRatio, kind, |at| {
                    self.swept_ratio(at, Parameter::ContactDampingRatio).map(ContactDampingRatio::Ratio)
                })
                .map(ContactDampingRecipe::Ratio),
        });
        let damping_curve = keys.optional("damping_curve", Slot::DampingCurve.about(), |at| {
            self.slot(at, Slot::DampingCurve, kind, read_curve)
        });
        let pull = "The surface does not pull at a particle that leaves it";
        let no_tension = keys.optional("no_tension", pull, |at| at.boolean());
        keys.close()?;
        Some(SurfaceRecipe::Resilient {
            stiffness: stiffness?,
            untuned_ratio: untuned_ratio?.or_else(|| self.by_default(untuned, kind)),
            damping: damping?,
            damping_curve: damping_curve?.or_else(|| self.by_default(Slot::DampingCurve, kind)),
            no_tension: no_tension?.unwrap_or(false),
        })
    }

    /// A stiffness, what it is tuned to, an assumption, or swept between `tuned` and `untuned`.
    fn stiffness(&self, at: At<'_>, kind: &'static Kind) -> Option<Given<FloorStiffness>> {
        let tunings = [
            ("tuned", FloorStiffness::Clean),
            ("clean", FloorStiffness::Clean),
            ("loaded", FloorStiffness::Loaded),
            ("untuned", FloorStiffness::Untuned),
        ];
        if let Some((_, tuning)) = tunings.into_iter().find(|(word, _)| at.is_word(word)) {
            return Some(Given::Stated(tuning));
        }
        if self.is_swept(at, Parameter::FloorTuning) {
            return Some(Given::Stated(FloorStiffness::Clean));
        }
        self.slot(at, Slot::Stiffness, kind, |at| at.above_zero(Dimension::Stiffness).map(FloorStiffness::Stiffness))
    }

    pub(super) fn stop(&self, at: At<'_>, kind: &'static Kind) -> Option<StopRecipe> {
        let rebound = || self.left_out(Slot::StopRestitution, kind, 0.0);
        if at.is_word("assumed") {
            let length = self.slot(at, Slot::StopLength, kind, |_| None)?;
            return Some(StopRecipe { length, restitution: rebound() });
        }
        let keys = at.keys("a limit stop")?;
        let length = keys.required("length", "Length of the limit stop", |at| {
            self.slot(at, Slot::StopLength, kind, |at| {
                self.swept_or(at, Parameter::StopLength, |at| at.above_zero(Dimension::Length))
            })
        });
        let rebounds =
            keys.optional("restitution", RESTITUTION, |at| self.slot(at, Slot::StopRestitution, kind, restitution));
        keys.close()?;
        Some(StopRecipe { length: length?, restitution: rebounds?.unwrap_or_else(rebound) })
    }

    pub(super) fn walls(&self, at: At<'_>, kind: &'static Kind) -> Option<WallRecipe> {
        let keys = at.keys("a pair of soft walls")?;
        let stiffness_ratio = keys.required("stiffness_ratio", "kw/ks: stiffness over that of the structure", |at| {
            self.sweepable(at, Parameter::WallStiffnessRatio)
        });
        let damping = keys.required("damping", "Damping of the walls", |at| self.quantity(at, Dimension::Damping));
        let mass = keys.optional("ceiling_mass_ratio", "Mass of the ceiling over that of the base", |at| {
            self.slot(at, Slot::CeilingMassRatio, kind, |at| at.ratio())
        });
        keys.close()?;
        Some(WallRecipe {
            stiffness_ratio: stiffness_ratio?,
            damping: damping?,
            ceiling_mass_ratio: mass?.or_else(|| self.by_default(Slot::CeilingMassRatio, kind)),
        })
    }
}

fn restitution(at: At<'_>) -> Option<f64> {
    at.within([0.0, 1.0], "a coefficient of restitution lies between 0 and 1")
}
