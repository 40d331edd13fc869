//! What every page would otherwise explain again: how to read it, once.

use super::tally::{VERDICTS, mark, meaning};

const SYMBOLS: &str = "\
| Symbol | Meaning |
| --- | --- |
| ψ | velocity ratio: RMS velocity without damper over RMS velocity with it; above 1 the damper helps |
| η | displacement ratio: the same with the standard deviation of the displacement |
| f′ = F/(m g) | dimensionless forcing amplitude: force F over the weight of the base mass m; an impulse is J = f′ m g τ, with τ = 1/ω unless the assumptions state another time |
| ω′ = ω/ωn | frequency ratio: forcing frequency over the natural frequency ωn = √(ks/m) |
| m′ | mass ratio: mass of the damper, particle and enclosure, over that of the structure; with one mass, of the particle over the base, mp/m |
| c′ = c/(2 √(ks m)) | structural damping ratio |
| cf/(2 √(kf mp)) | damping ratio of the resilient floor and ceiling under the particle |
| kf/ks, kw/ks | stiffness of floor and ceiling, and of the soft walls, over that of the structure |
| h′ = h ωn²/g | dimensionless gap clearance: free height h between floor and ceiling; ∞ without a ceiling |
| a ω²/g | dimensionless base amplitude of a harmonic force F = m a ω² |
";

const TEXT: &str = "\
A page opens with its result. Its table has one row for each statement of the study: a *number*, or a *claim* in words. An \
open diamond in a figure is a number that the study’s text quotes. Its bar is the tolerance of its verdict, the thick inner part u_D.

**Numbers** are compared after ASME V&V 20. S is the number here, D the published one, E = S − D, and \
u_val = √(u_num² + u_input² + u_D²): u_num covers discretisation, the grid of the sweep and the spread of the ensemble, u_input \
the inputs that the study does not state, u_D half a unit of the last printed digit. The two agree if |E| ≤ 2 u_val. \
**± is 2 u_val** wherever a number is compared with the study. A tolerance set by hand replaces 2 u_val and is shown beside the \
verdict. Agreement is *reproduced* only if it could have failed: where ± alone is wider than a tenth of D (and than the printed \
digits allow), the number is blocked or undecidable, unless it was fitted and is off by no more than that. **Claims** are decided over the whole table; “x % apart” is a difference over the larger of the numbers. The *margin* is how far the numbers \
are on the right side of what the claim requires. Where it is small it is shown ± 2 u; u is the error of the grid and of the mean over \
the ensemble, which is smaller than the spread of single runs. A claim is *too close to call* where ± is larger than the margin.

Entries **used in fits** helped to choose an unstated input. Those of them that agree are *fitted*, which proves nothing; the others \
differ all the same, or cannot be decided. **Held out** entries were kept aside by a calibration to test it. Only entries that are held out or in no fit are evidence, and those fitted ones that still agree when \
*left out*, that is, with inputs chosen by the others alone. The page of the calibration gives the share of all sets of inputs that \
would bring them there, too (“by chance”).

**Runs.** *Event-driven* runs follow the exact motion from one contact to the next; *fixed step* runs follow a scheme that \
looks for contacts once a step. Impact dampers are chaotic in wide ranges: there the mean of an *ensemble* of slightly \
perturbed starts is shown, and the band is its standard deviation. Every run is checked by its balances of momentum and energy; \
the *smallest margin* is the distance by which a surface would have to move to change the order of contacts, and *ties* are \
simultaneous events.
";

/// The section of the index.
pub(super) fn section() -> String {
    let mut text = format!("## How to read\n\n{TEXT}\n| | Verdict | Meaning |\n| --- | --- | --- |\n");
    for verdict in VERDICTS {
        text += &format!("| {} | {} | {} |\n", mark(verdict), verdict.word(), meaning(verdict));
    }
    format!("{text}\n<details><summary>Symbols</summary>\n\n{SYMBOLS}\n</details>\n\n")
}
