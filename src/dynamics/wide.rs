//! One source for several processors: a method is compiled twice, for every processor and for registers of four numbers, and
//! what this processor can do decides which of them runs.
//!
//! Nothing is contracted and no sum is reordered, so that both give the same bits.

/// `fn name | wide_name (…) = body`: `name` runs `body`, which is to be inlined always, as this processor runs it best.
macro_rules! widened {
    ($(#[$doc:meta])* $vis:vis fn $name:ident | $wide:ident (&$this:ident $(, $arg:ident: $type:ty)* $(,)?) $(-> $out:ty)? = $body:ident) => {
        $(#[$doc])*
        #[inline]
        $vis fn $name(&$this, $($arg: $type),*) $(-> $out)? {
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has the registers.
                return unsafe { $this.$wide($($arg),*) };
            }
            $this.$body($($arg),*)
        }
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn $wide(&$this, $($arg: $type),*) $(-> $out)? { $this.$body($($arg),*) }
    };
    ($(#[$doc:meta])* $vis:vis fn $name:ident | $wide:ident (&mut $this:ident $(, $arg:ident: $type:ty)* $(,)?) $(-> $out:ty)? = $body:ident) => {
        $(#[$doc])*
        #[inline]
        $vis fn $name(&mut $this, $($arg: $type),*) $(-> $out)? {
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has the registers.
                return unsafe { $this.$wide($($arg),*) };
            }
            $this.$body($($arg),*)
        }
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn $wide(&mut $this, $($arg: $type),*) $(-> $out)? { $this.$body($($arg),*) }
    };
}

pub(crate) use widened;
