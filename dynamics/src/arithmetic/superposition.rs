//! Matrices as sums of their rows: y = Σ xᵢ rᵢ, many numbers of y at a time and each row once.
//!
//! Rows are cut into strips of so many registers as a processor can add to side by side: an addition waits for the one before it in its
//! own register alone.

use std::ops::Range;

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;

/// Registers of a strip.
const STRIP: usize = 8;

/// The rows, filled up with zeros to whole registers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Superposition {
    /// Numbers of a row.
    length: usize,
    /// Registers of a row.
    registers: usize,
    /// How many rows there are.
    count: usize,
    /// Strip after strip, of `STRIP` registers but the last, and in each the rows.
    entries: Vec<[f64; WIDTH]>,
}

impl Superposition {
    /// Of rows of `length` numbers each, one after the other, in the room of this one.
    pub(crate) fn of_rows(self, length: usize, entries: &[f64]) -> Self {
        let mut all = self.zeros(length, entries.len() / length.max(1));
        for strip in strips(all.registers) {
            let rows = all.entries[strip.start * all.count..strip.end * all.count].chunks_exact_mut(strip.len());
            for (to, from) in rows.zip(entries.chunks_exact(length)) {
                let from = &from[strip.start * WIDTH..length.min(strip.end * WIDTH)];
                to.as_flattened_mut()[..from.len()].copy_from_slice(from);
            }
        }
        all
    }

    /// The same of the columns of a matrix that is given row by row, `length` rows of `columns` numbers.
    pub(crate) fn of_columns(self, length: usize, columns: usize, entries: &[f64]) -> Self {
        let mut all = self.zeros(length, columns);
        for strip in strips(all.registers) {
            let rows = all.entries[strip.start * columns..strip.end * columns].chunks_exact_mut(strip.len());
            let from = &entries[strip.start * WIDTH * columns..length.min(strip.end * WIDTH) * columns];
            for (k, to) in rows.enumerate() {
                let column = from.chunks_exact(columns).map(|row| row[k]);
                to.as_flattened_mut().iter_mut().zip(column).for_each(|(to, from)| *to = from);
            }
        }
        all
    }

    fn zeros(mut self, length: usize, count: usize) -> Self {
        let registers = length.div_ceil(WIDTH);
        self.entries.clear();
        self.entries.resize(count * registers, [0.0; WIDTH]);
        Self { length, registers, count, ..self }
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        WIDTH * self.entries.len()
    }

    /// y = Σ xᵢ rᵢ; rows beyond the last x count nothing.
    #[inline(always)]
    pub(crate) fn sum_by_registers(&self, x: &[f64], y: &mut [f64]) {
        let (mut rows, mut y, mut left) = (&self.entries[..], &mut y[..self.length], self.registers);
        loop {
            let strip = left.min(STRIP);
            let (now, others) = rows.split_at(strip * self.count);
            match strip {
                0 => {}
                1 => put(summed::<1>(now, x), y),
                2 => put(summed::<2>(now, x), y),
                3 => put(summed::<3>(now, x), y),
                4 => put(summed::<4>(now, x), y),
                5 => put(summed::<5>(now, x), y),
                6 => put(summed::<6>(now, x), y),
                7 => put(summed::<7>(now, x), y),
                _ => put(summed::<STRIP>(now, x), y),
            }
            left -= strip;
            if left == 0 {
                return;
            }
            (rows, y) = (others, &mut y[strip * WIDTH..]);
        }
    }
}

/// Which of so many registers make a strip.
fn strips(registers: usize) -> impl Iterator<Item = Range<usize>> {
    (0..registers).step_by(STRIP).map(move |first| first..registers.min(first + STRIP))
}

/// Σ xᵢ rᵢ of rows that are so many registers long.
#[inline(always)]
fn summed<const REGISTERS: usize>(rows: &[[f64; WIDTH]], x: &[f64]) -> [Four; REGISTERS] {
    let mut sums = [Four::ZERO; REGISTERS];
    for (x, row) in x.iter().zip(rows.as_chunks::<REGISTERS>().0) {
        for (sum, entries) in sums.iter_mut().zip(row) {
            *sum = *sum + Four::new(*entries) * *x;
        }
    }
    sums
}

/// The numbers of several registers, as far as `y` goes.
#[inline(always)]
fn put<const REGISTERS: usize>(registers: [Four; REGISTERS], y: &mut [f64]) {
    let (whole, part) = y.as_chunks_mut::<WIDTH>();
    let count = whole.len();
    // By reference: an array that is gone through by value is copied first.
    whole.iter_mut().zip(&registers).for_each(|(y, register)| *y = register.array());
    let Some([a, b, c, _]) = registers.get(count).map(|register| register.array()) else { return };
    match part {
        [x] => *x = a,
        [x, y] => (*x, *y) = (a, b),
        [x, y, z] => (*x, *y, *z) = (a, b, c),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_sum_up_the_same_bits_as_row_after_row() {
        for length in 0..50_u32 {
            let number = |i: u32| libm::sin(f64::from(i) * 0.37);
            let x: Vec<f64> = (0..7).map(number).collect();
            let count = length as usize;
            let entries: Vec<f64> = (0..7 * length).map(|i| number(i + 11)).collect();
            let mut expected = vec![0.0; count];
            for (x, row) in x.iter().zip(entries.chunks(count.max(1))) {
                expected.iter_mut().zip(row).for_each(|(sum, entry)| *sum += entry * x);
            }
            let matrix = Superposition::default().of_rows(count, &entries);
            let mut sums = vec![0.0; count];
            matrix.sum_by_registers(&x, &mut sums);
            assert_eq!(sums, expected, "{length} numbers");
            let columns: Vec<f64> =
                (0..count).flat_map(|i| (0..7).map(move |k| (i, k))).map(|(i, k)| entries[k * count + i]).collect();
            assert_eq!(Superposition::default().of_columns(count, 7, &columns).entries, matrix.entries);
        }
    }
}
