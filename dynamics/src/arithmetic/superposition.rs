//! Matrices as sums of their rows: y = Σ xᵢ rᵢ, many numbers of y at a time and each row once.

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::wide::widened;

/// The rows, filled up with zeros to whole registers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Superposition {
    /// Numbers of a row.
    length: usize,
    /// Registers of a row.
    registers: usize,
    rows: Vec<[f64; WIDTH]>,
}

impl Superposition {
    /// Of rows of `length` numbers each, one after the other.
    pub(crate) fn new(length: usize, entries: &[f64]) -> Self {
        let registers = length.div_ceil(WIDTH);
        let count = entries.len() / length.max(1);
        let mut rows = vec![[0.0; WIDTH]; count * registers];
        for (to, from) in rows.chunks_exact_mut(registers.max(1)).zip(entries.chunks_exact(length.max(1))) {
            to.as_flattened_mut()[..length].copy_from_slice(from);
        }
        Self { length, registers, rows }
    }

    /// Of the columns of a matrix that is given row by row, `length` rows of `columns` numbers.
    pub(crate) fn transposed(length: usize, columns: usize, entries: &[f64]) -> Self {
        let registers = length.div_ceil(WIDTH);
        let mut rows = vec![[0.0; WIDTH]; columns * registers];
        for (i, entries) in entries.chunks_exact(columns.max(1)).take(length).enumerate() {
            let to = rows.iter_mut().skip(i / WIDTH).step_by(registers);
            to.zip(entries).for_each(|(to, from)| to[i % WIDTH] = *from);
        }
        Self { length, registers, rows }
    }

    /// The rows.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.rows.chunks_exact(self.registers.max(1)).map(|row| &row.as_flattened()[..self.length])
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        WIDTH * self.rows.len()
    }

    widened! {
        /// y = Σ xᵢ rᵢ; rows beyond the last x count nothing.
        pub(crate) fn sum | sum_wide (&self, x: &[f64], y: &mut [f64]) = sum_by_registers
    }

    #[inline(always)]
    pub(crate) fn sum_by_registers(&self, x: &[f64], y: &mut [f64]) {
        let mut y = &mut y[..self.length];
        match self.registers {
            1 => return put(narrow::<1>(&self.rows, x), y),
            2 => return put(narrow::<2>(&self.rows, x), y),
            _ => {}
        }
        let mut first = 0;
        while self.registers - first >= 4 {
            y = self.strip::<4>(first, x, y);
            first += 4;
        }
        match self.registers - first {
            3 => self.strip::<3>(first, x, y),
            2 => self.strip::<2>(first, x, y),
            1 => self.strip::<1>(first, x, y),
            _ => y,
        };
    }

    /// So many registers of y; gives what is left of it.
    #[inline(always)]
    fn strip<'a, const MANY: usize>(&self, first: usize, x: &[f64], y: &'a mut [f64]) -> &'a mut [f64] {
        let mut sums = [Four::ZERO; MANY];
        for (x, row) in x.iter().zip(self.rows.chunks_exact(self.registers)) {
            if let Some(row) = row[first..].first_chunk::<MANY>() {
                for (sum, entries) in sums.iter_mut().zip(row) {
                    *sum = *sum + Four::new(*entries) * *x;
                }
            }
        }
        let (now, rest) = y.split_at_mut(y.len().min(MANY * WIDTH));
        put(sums, now);
        rest
    }
}

/// Σ xᵢ rᵢ of rows that are so many registers long.
#[inline(always)]
fn narrow<const MANY: usize>(rows: &[[f64; WIDTH]], x: &[f64]) -> [Four; MANY] {
    let mut sums = [Four::ZERO; MANY];
    for (x, row) in x.iter().zip(rows.as_chunks::<MANY>().0) {
        for (sum, entries) in sums.iter_mut().zip(row) {
            *sum = *sum + Four::new(*entries) * *x;
        }
    }
    sums
}

/// The numbers of several registers, as far as `y` goes.
#[inline(always)]
fn put<const MANY: usize>(registers: [Four; MANY], y: &mut [f64]) {
    let (whole, part) = y.as_chunks_mut::<WIDTH>();
    let count = whole.len();
    whole.iter_mut().zip(registers).for_each(|(y, register)| *y = register.array());
    if let Some(register) = registers.get(count) {
        part.iter_mut().zip(register.array()).for_each(|(y, number)| *y = number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_processor_sums_up_the_same_bits_as_row_after_row() {
        for length in 0..40_u32 {
            let number = |i: u32| libm::sin(f64::from(i) * 0.37);
            let x: Vec<f64> = (0..7).map(number).collect();
            let entries: Vec<f64> = (0..7 * length).map(|i| number(i + 11)).collect();
            let matrix = Superposition::new(length as usize, &entries);
            let mut expected = vec![0.0; length as usize];
            for (x, row) in x.iter().zip(entries.chunks(length.max(1) as usize)) {
                expected.iter_mut().zip(row).for_each(|(sum, entry)| *sum += entry * x);
            }
            let (mut here, mut everywhere) = (expected.clone(), expected.clone());
            matrix.sum(&x, &mut here);
            matrix.sum_by_registers(&x, &mut everywhere);
            assert_eq!([&here, &everywhere], [&expected; 2], "{length} numbers");
            let by_columns: Vec<f64> = (0..length as usize)
                .flat_map(|i| (0..7).map(move |k| (i, k)))
                .map(|(i, k)| entries[k * length as usize + i])
                .collect();
            let same = Superposition::transposed(length as usize, 7, &by_columns);
            assert!(matrix.rows().flatten().eq(same.rows().flatten()));
            assert!(matrix.rows().flatten().copied().eq(entries));
        }
    }
}
