//! Random numbers that depend on their place alone: every individual of every generation has a stream of its own.
//!
//! Streams are xoshiro256++ (Blackman and Vigna), filled by splitmix64 from a seed and the coordinates of the place. No thread
//! and no earlier draw has a part in it.

use std::f64::consts::TAU;

/// A stream of random numbers.
#[derive(Debug, Clone)]
pub struct Stream {
    state: [u64; 4],
    /// The second normal number of a pair.
    spare: Option<f64>,
}

/// One step of splitmix64.
fn splitmix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

impl Stream {
    /// The stream of a place, such as (generation, individual), under a seed.
    #[must_use]
    pub fn of(seed: u64, place: &[u64]) -> Self {
        let mut mixed = seed;
        for coordinate in place {
            // What a coordinate adds passes through the whole mixer, so that neighbours have nothing in common.
            mixed = splitmix(&mut mixed) ^ coordinate.wrapping_mul(0xD6E8_FEB8_6659_FD93);
        }
        Self { state: std::array::from_fn(|_| splitmix(&mut mixed)), spare: None }
    }

    fn next(&mut self) -> u64 {
        let s = &mut self.state;
        let drawn = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = s[3].rotate_left(45);
        drawn
    }

    /// Evenly from 0 (included) to 1 (not).
    pub fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 * (0.5 / (1_u64 << 52) as f64)
    }

    /// A whole number below `count`; 0 if there is none.
    pub fn below(&mut self, count: usize) -> usize {
        ((self.uniform() * count as f64) as usize).min(count.saturating_sub(1))
    }

    /// Heads or tails.
    pub fn coin(&mut self) -> bool {
        self.uniform() < 0.5
    }

    /// Normally distributed, mean 0 and deviation 1 (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        let angle = TAU * self.uniform();
        self.spare = Some(radius * libm::sin(angle));
        radius * libm::cos(angle)
    }
}
