//! The validated `starts`: a box of initial conditions that runs start from at random, to find all motions that a scene may end in and
//! the share of the box that each attracts (Datseris & Wagemakers, Chaos 32, 023104, 2022).
//!
//! The k-th start is the same in every case of a sweep: random numbers depend on the seed, k and the coordinate alone. What differs
//! from case to case is then the scene and not the draw.

use serde::{Deserialize, Serialize};

use crate::measure::column_of_damper;
use crate::optimise::Stream;
use crate::scene::{ParticleStart, Scene, Start};

/// Random starts of every case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Starts {
    /// How many.
    pub count: u32,
    /// Of the random numbers.
    pub seed: u32,
    /// Displacement of the structure, m; `None`: as the scene says.
    pub displacement: Option<Interval>,
    /// Velocity of the structure, m/s; `None`: as the scene says.
    pub velocity: Option<Interval>,
    /// One a damper; empty: as the scene says.
    pub particles: Vec<ParticleBox>,
}

/// Evenly distributed from the one to the other; a single value where both are the same.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// The smallest value.
    pub from: f64,
    /// The largest.
    pub to: f64,
}

/// Where a particle may start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ParticleBox {
    /// At rest on its floor.
    OnFloor,
    /// Between floor and ceiling.
    InFlight {
        /// Height over the floor.
        height: HeightBox,
        /// Velocity relative to the floor, m/s.
        velocity: Interval,
    },
}

/// Heights over a floor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HeightBox {
    /// m.
    Of(Interval),
    /// As shares of the gap clearance, whatever that is.
    OfGap(Interval),
}

/// The lists of starts in the table: coordinates of all starts that end in the motion of the row.
pub const START_LISTS: [(&str, &str); 4] =
    [("start_displacement", "m"), ("start_velocity", "m/s"), ("start_height", "m"), ("start_particle_velocity", "m/s")];

impl Interval {
    /// The value at a share of it; its ends are met to the bit.
    fn at(self, share: f64) -> f64 {
        if share >= 1.0 { self.to } else { self.from + share * (self.to - self.from) }
    }

    /// It holds more than one value.
    #[must_use]
    pub fn varies(self) -> bool {
        self.from < self.to
    }
}

impl Starts {
    /// Start number `number`, from 0.
    #[must_use]
    pub fn start(&self, number: u32, scene: &Scene) -> Start {
        let mut stream = Stream::of(u64::from(self.seed), &[u64::from(number)]);
        self.place(scene, || stream.uniform())
    }

    /// The corner of the box where everything is smallest, and that where it is largest.
    pub(super) fn corners(&self, scene: &Scene) -> [Start; 2] {
        [0.0, 1.0].map(|share| self.place(scene, || share))
    }

    /// Every coordinate draws one number, whether it varies or not, so that adding a coordinate to the box moves no other.
    fn place(&self, scene: &Scene, mut share: impl FnMut() -> f64) -> Start {
        let given = scene.start.clone().unwrap_or_default();
        let [far, fast] = [share(), share()];
        let displacement = self.displacement.map_or(given.displacement, |it| it.at(far));
        let velocity = self.velocity.map_or(given.velocity, |it| it.at(fast));
        let particle = |(index, one): (usize, &ParticleBox)| {
            let [high, fast] = [share(), share()];
            let ParticleBox::InFlight { height, velocity } = *one else { return ParticleStart::OnFloor };
            let height = match height {
                HeightBox::Of(interval) => interval.at(high),
                HeightBox::OfGap(shares) => shares.at(high) * scene.dampers.get(index).map_or(0.0, |damper| damper.gap),
            };
            ParticleStart::InFlight { height, velocity: velocity.at(fast) }
        };
        let particles = match self.particles.as_slice() {
            [] => given.particles,
            boxes => boxes.iter().enumerate().map(particle).collect(),
        };
        Start { displacement, velocity, particles }
    }

    /// The damper whose heights are shares of a gap that has no end, by its place in the scene.
    pub(super) fn endless(&self, scene: &Scene) -> Option<usize> {
        let of_gap = |one: &ParticleBox| matches!(one, ParticleBox::InFlight { height: HeightBox::OfGap(_), .. });
        self.particles.iter().zip(&scene.dampers).position(|(one, damper)| of_gap(one) && !damper.gap.is_finite())
    }

    /// The lists of its table, with their units: only of coordinates that vary.
    pub(crate) fn lists(&self) -> Vec<(String, &'static str)> {
        self.coordinates(|name, unit, _| Some((name, unit)))
    }

    /// The coordinates that vary, each of all these starts.
    pub(crate) fn columns(&self, starts: &[Start]) -> Vec<(String, &'static str, Vec<f64>)> {
        self.coordinates(|name, unit, of| Some((name, unit, starts.iter().map(of).collect())))
    }

    fn coordinates<T>(&self, take: impl Fn(String, &'static str, &dyn Fn(&Start) -> f64) -> Option<T>) -> Vec<T> {
        let [displacement, velocity, height, speed] = START_LISTS;
        let varies = |interval: Option<Interval>| interval.is_some_and(Interval::varies);
        let mut all = Vec::new();
        if varies(self.displacement) {
            all.extend(take(displacement.0.into(), displacement.1, &|start| start.displacement));
        }
        if varies(self.velocity) {
            all.extend(take(velocity.0.into(), velocity.1, &|start| start.velocity));
        }
        for (index, one) in self.particles.iter().enumerate() {
            let ParticleBox::InFlight { height: heights, velocity } = *one else { continue };
            let in_flight = |start: &Start| match start.particles.get(index) {
                Some(ParticleStart::InFlight { height, velocity }) => [*height, *velocity],
                Some(ParticleStart::OnFloor) | None => [0.0; 2],
            };
            if heights.interval().varies() {
                let name = column_of_damper(height.0, index);
                all.extend(take(name, height.1, &|start| in_flight(start)[0]));
            }
            if velocity.varies() {
                let name = column_of_damper(speed.0, index);
                all.extend(take(name, speed.1, &|start| in_flight(start)[1]));
            }
        }
        all
    }
}

impl HeightBox {
    /// In m, or in gaps.
    #[must_use]
    pub fn interval(self) -> Interval {
        let (Self::Of(interval) | Self::OfGap(interval)) = self;
        interval
    }
}

/// What the table of random starts says of each motion, beside its name, its multipliers and what is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BasinColumn {
    /// Which motion.
    Basin,
    /// Whether it is the best of its case.
    Rank,
    /// Starts that end in it.
    Starts,
    /// Over all starts.
    Share,
    /// Standard error of the share.
    ShareError,
    /// None: a share is counted.
    ShareSpread,
    /// Lower end of the share's interval.
    ShareLow,
    /// Its upper end.
    ShareHigh,
    /// How far its starts differ.
    RmsDifference,
}

impl BasinColumn {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 9] = [
        Self::Basin,
        Self::Rank,
        Self::Starts,
        Self::Share,
        Self::ShareError,
        Self::ShareSpread,
        Self::ShareLow,
        Self::ShareHigh,
        Self::RmsDifference,
    ];

    /// The word in the table.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Basin => "basin",
            Self::Rank => "rank",
            Self::Starts => "starts",
            Self::Share => "share",
            Self::ShareError => "share_num",
            Self::ShareSpread => "share_spread",
            Self::ShareLow => "share_low",
            Self::ShareHigh => "share_high",
            Self::RmsDifference => "rms_difference",
        }
    }

    /// What it says, in one line.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Self::Basin => {
                "the motion that these starts end in, as in `motion`; of several of one name the second by RMS velocity is `periodic 1:1 (2)`"
            }
            Self::Rank => {
                "`best` where no other motion of the case has a smaller RMS velocity, `other` elsewhere and where the starts have not settled"
            }
            Self::Starts => "starts that end in it",
            Self::Share => "these over all starts",
            Self::ShareError => "its standard error: the farther end of Wilson's interval of one standard deviation",
            Self::ShareSpread => "0: the share is counted once, over all starts",
            Self::ShareLow => "lower end of Wilson's 95 % interval of the share",
            Self::ShareHigh => "upper end of that interval",
            Self::RmsDifference => {
                "how far the RMS velocities of these starts lie apart, relative to the largest: rounding where the motion comes again"
            }
        }
    }

    /// It holds words; the others hold numbers.
    #[must_use]
    pub fn is_word(self) -> bool {
        matches!(self, Self::Basin | Self::Rank)
    }
}

/// Whether a motion is the one to be wished for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rank {
    /// No other motion of the case has a smaller RMS velocity.
    Best,
    /// Another has, or the starts have not settled.
    Other,
}

impl Rank {
    /// The word in the table.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Best => "best",
            Self::Other => "other",
        }
    }

    /// That of a word in the table.
    pub(crate) fn of_word(word: &str) -> Option<Self> {
        [Self::Best, Self::Other].into_iter().find(|rank| rank.word() == word)
    }
}
