//! One source for several processors: a method is compiled twice, for every processor and for registers of four numbers, and
//! what this processor can do decides which of them runs.
//!
//! What such a method calls, and is marked `inline(always)`, is compiled for the same processor; so one check is enough for many
//! segments.
//!
//! Nothing is contracted and no sum is reordered, so that both give the same bits.

/// `fn name | wide_name (…) = body`: `name` runs `body`, which is to be inlined always, as this processor runs it best.
macro_rules! widened {
    ($(#[$doc:meta])* $vis:vis fn $name:ident | $wide:ident (&mut $this:ident $($rest:tt)*) $(-> $out:ty)? = $body:ident) => {
        widened!(@ $(#[$doc])* $vis fn $name | $wide | $body | $this [&mut $this] ($($rest)*) $(-> $out)?);
    };
    ($(#[$doc:meta])* $vis:vis fn $name:ident | $wide:ident (&$this:ident $($rest:tt)*) $(-> $out:ty)? = $body:ident) => {
        widened!(@ $(#[$doc])* $vis fn $name | $wide | $body | $this [&$this] ($($rest)*) $(-> $out)?);
    };
    (
        @ $(#[$doc:meta])* $vis:vis fn $name:ident | $wide:ident | $body:ident | $this:ident [$($receiver:tt)+]
        ($(, $arg:ident: $type:ty)* $(,)?) $(-> $out:ty)?
    ) => {
        $(#[$doc])*
        #[inline]
        $vis fn $name($($receiver)+, $($arg: $type),*) $(-> $out)? {
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has the registers.
                return unsafe { $this.$wide($($arg),*) };
            }
            $this.$body($($arg),*)
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn $wide($($receiver)+, $($arg: $type),*) $(-> $out)? {
            $this.$body($($arg),*)
        }
    };
}

pub(crate) use widened;
