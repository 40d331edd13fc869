//! Registration: from the list of structures to the enum of all of them and the table of their kinds.

/// Declares each structure's module, and makes of them the enum `Structure` and the table `KINDS`.
macro_rules! structures {
    ($($module:ident::$Name:ident,)*) => {
        $(mod $module; pub use $module::$Name;)*

        /// What vibrates.
        #[derive(Debug, Clone, PartialEq)]
        #[expect(missing_docs, reason = "documented at the structures")]
        pub enum Structure {
            $($Name($Name),)*
        }

        impl Structure {
            /// Its matrices and shapes.
            #[must_use]
            pub fn model(&self) -> &dyn Model {
                match self {
                    $(Self::$Name(model) => model,)*
                }
            }
        }

        $(impl From<$Name> for Structure {
            fn from(model: $Name) -> Self {
                Self::$Name(model)
            }
        })*

        /// Every kind of structure, in the order in which they are offered.
        pub const KINDS: &[&Kind] = &[$(&$module::KIND,)*];
    };
}
pub(super) use structures;
