//! What several actions put together once, whichever of them comes first.

use std::any::Any;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// A place for it. Clones are the same place.
#[derive(Clone, Default)]
pub struct Common(Arc<OnceLock<Arc<dyn Any + Send + Sync>>>);

impl fmt::Debug for Common {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Common")
    }
}

impl Common {
    /// What is there, or what `make` gives, for which all others wait. All who ask ask for the same type.
    pub fn get<T: Send + Sync + 'static>(&self, make: impl Fn() -> T) -> Arc<T> {
        let any = self.0.get_or_init(|| Arc::new(make())).clone();
        any.downcast().unwrap_or_else(|_| Arc::new(make()))
    }
}

#[cfg(test)]
mod tests {
    use super::Common;

    #[test]
    fn it_is_made_once() {
        let common = Common::default();
        let of = |value: u32| *common.clone().get(|| value);
        assert_eq!((of(3), of(4)), (3, 3));
        assert_eq!(*common.get(|| "another type"), "another type");
    }
}
