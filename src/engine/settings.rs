//! Values that a caller gives to parameters in place of their defaults.

use std::collections::BTreeMap;
use std::sync::Arc;

use fretwork_language::Tree;

/// One such value.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Setting {
    /// As typed on the command line.
    Text(Arc<str>),
    /// From an artifact's `each`.
    Value(Tree),
}

/// Names of parameters and values for them. Part of the key of every query behind the parse, so
/// that one build may hold a spec under several settings.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Settings(Arc<BTreeMap<Arc<str>, Setting>>);

impl Settings {
    /// The settings of a command line; of a name given twice the last value counts.
    pub fn new<'a>(sets: impl IntoIterator<Item = (&'a str, &'a str)>) -> Settings {
        let entries = sets
            .into_iter()
            .map(|(name, value)| (name.into(), Setting::Text(value.into())));
        Settings(Arc::new(entries.collect()))
    }

    /// These settings, with `values` in front of them.
    pub fn with(&self, values: impl IntoIterator<Item = (Arc<str>, Tree)>) -> Settings {
        let mut map = (*self.0).clone();
        map.extend(
            values
                .into_iter()
                .map(|(name, value)| (name, Setting::Value(value))),
        );
        Settings(Arc::new(map))
    }

    /// These settings, with those of `more` in front of them.
    pub fn and(&self, more: &Settings) -> Settings {
        let mut map = (*self.0).clone();
        map.extend(
            more.0
                .iter()
                .map(|(name, value)| (name.clone(), value.clone())),
        );
        Settings(Arc::new(map))
    }

    /// These settings for the names that `keep` holds for.
    pub fn only(&self, keep: impl Fn(&str) -> bool) -> Settings {
        let kept = self.0.iter().filter(|(name, _)| keep(name));
        Settings(Arc::new(
            kept.map(|(name, setting)| (name.clone(), setting.clone()))
                .collect(),
        ))
    }

    /// The value for `name`, if there is one.
    pub fn get(&self, name: &str) -> Option<&Setting> {
        self.0.get(name)
    }

    /// The values that come from an artifact's `each`, as text.
    pub fn each_values(&self) -> impl Iterator<Item = (&str, Arc<str>)> {
        self.0.iter().filter_map(|(name, setting)| match setting {
            Setting::Value(value) => Some((
                &**name,
                value.to_text().unwrap_or_else(|| value.describe().into()),
            )),
            Setting::Text(_) => None,
        })
    }

    /// The names and what is set for them, in order.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &Setting)> {
        self.0.iter().map(|(name, setting)| (&**name, setting))
    }
}
