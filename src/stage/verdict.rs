//! Whether the limits of a force profile hold, and what is to be said where they do not.

use super::force_profile::Profile;
use super::strength::Analysed;
use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::Point3;
use fretwork_geometry::shell::Strength;
use fretwork_language::Section;
use fretwork_language::kinds::force_profiles::ForceProfile;
use fretwork_language::value::shown_number;

/// Whether a limit holds is not told where a value is nearer to it than this part of it: results differ
/// by less from one processor to another.
const MARGIN: f64 = 1e-4;

/// A limit beside what was found.
struct Judged {
    /// How far the value is beyond the limit, as a part of the limit.
    excess: f64,
    /// The field that sets the limit.
    field: &'static str,
    /// What is wrong if it does not hold.
    text: String,
}

/// What is to be said of the limits of a profile: an error where one does not hold that is required, else
/// warnings.
///
/// # Errors
/// With the limits that do not hold.
pub fn verdict(
    action: &Action,
    said: &ForceProfile,
    profile: &Profile,
    found: &Analysed,
) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    let worst = found.strength.worst_gravity;
    let at = worst.map_or(found.strength.weakest_at, |worst| worst.weakest_at);
    let wider = "make it thicker, or its features wider";
    let mut help = match at {
        None => wider.to_owned(),
        Some(Point3 { x, y, z }) => {
            format!("the weakest place is near ({x:.2}, {y:.2}, {z:.2}): {wider}")
        }
    };
    if let Some(bridged) = bridged(action, profile.max_stress, &found.strength) {
        help += &bridged;
    }
    let unit = action.definition.units.word();
    let judged = judged(said, (profile.max_stress, unit), &found.strength);
    let mut told: Vec<Diagnostic> = judged
        .into_iter()
        .filter_map(|judged| judged.told(said.require))
        .map(|told| told.at(action.span(), "analysed here").help(help.clone()))
        .collect();
    told.extend(
        unstrained(said, &found.strength).map(|told| told.at(action.span(), "analysed here")),
    );
    for load in &found.idle_loads {
        let message = format!(
            "load {} does nothing: its force is zero, or all that it acts on is held",
            load + 1
        );
        let warning = profile.at_load(*load, Diagnostic::warning(message));
        told.push(warning.at(action.span(), "analysed here"));
    }
    if found.is_sag_large {
        let sag = found.strength.max_displacement * action.definition.units.millimetres();
        let message = format!(
            "it sags by {sag:.1} mm, more than a tenth of its size: linear analysis no longer describes it"
        );
        told.push(Diagnostic::warning(message).at(action.span(), "analysed here"));
    }
    if told.iter().any(Diagnostic::is_error) {
        Err(told)
    } else {
        Ok(told)
    }
}

/// What else helps a shell whose stress is too large. The model of its loop is quicker than the analysis, and may find less
/// stress.
fn bridged(action: &Action, max_stress: f64, strength: &Strength) -> Option<String> {
    let worst = strength.worst_gravity.map_or(0.0, |worst| worst.p99);
    let excess = strength.stress.p99.max(worst) / max_stress;
    let is_shell = action.definition.id.section == Section::Shells;
    (is_shell && excess > 1.0 && excess.is_finite()).then(|| {
        let smaller = pascals(max_stress / excess).replace(' ', "");
        format!(", or have more bridges made by a smaller limit: `max_stress: \"{smaller}\"`")
    })
}

/// What is to be said where nothing strains the body: then every limit holds, and proves nothing.
fn unstrained(said: &ForceProfile, strength: &Strength) -> Option<Diagnostic> {
    let swept = strength.worst_gravity.map_or(0.0, |worst| worst.p99);
    if strength.stress.max > 0.0 || swept > 0.0 {
        return None;
    }
    let message = "nothing strains the body, so that its strength is not tested";
    let told = match said.require {
        true => Diagnostic::error(message),
        false => Diagnostic::warning(message),
    };
    Some(told.help("no force acts on it, or the supports hold all of it: give `gravity` or `loads`, and smaller supports"))
}

/// The limits that a profile sets. Of a sweep each value counts under the direction in which it is worst.
fn judged(
    said: &ForceProfile,
    (max_stress, unit): (f64, &str),
    strength: &Strength,
) -> Vec<Judged> {
    let (safety, moved, p99) = match &strength.worst_gravity {
        None => (
            strength.safety_factor,
            strength.max_displacement,
            strength.stress.p99,
        ),
        Some(worst) => (worst.safety_factor, worst.max_displacement, worst.p99),
    };
    let mut all = vec![Judged {
        excess: p99 / max_stress - 1.0,
        field: "max_stress",
        text: format!(
            "the stress is too large: 99 % of the body stay below {}, {} was allowed",
            pascals(p99),
            pascals(max_stress)
        ),
    }];
    let limits = said.limits.as_ref();
    if let (Some(wanted), Some([_, safety])) = (limits.and_then(|l| l.safety_factor), safety) {
        all.push(Judged {
            excess: wanted.0 / safety - 1.0,
            field: "safety_factor",
            text: format!(
                "the safety factor is {safety:.2}, {} was asked for",
                shown_number(wanted.0)
            ),
        });
    }
    if let Some(wanted) = limits.and_then(|limits| limits.max_displacement) {
        all.push(Judged {
            excess: moved / wanted.0 - 1.0,
            field: "max_displacement",
            text: format!(
                "a point moves by {} {unit}, {} {unit} was allowed",
                shown_number(moved),
                shown_number(wanted.0)
            ),
        });
    }
    all
}

impl Judged {
    /// What is to be said of it: nothing where it holds clearly.
    fn told(self, is_required: bool) -> Option<Diagnostic> {
        if self.excess.abs() <= MARGIN {
            let message = format!(
                "whether `{}` holds cannot be told: {}",
                self.field, self.text
            );
            return Some(Diagnostic::warning(message));
        }
        let is_broken = self.excess > 0.0;
        is_broken.then(|| match is_required {
            true => Diagnostic::error(self.text),
            false => Diagnostic::warning(self.text),
        })
    }
}

/// A stress for people.
pub fn pascals(value: f64) -> String {
    match value {
        v if v >= 1e6 => format!("{:.3} MPa", v / 1e6),
        v if v >= 1e3 => format!("{:.3} kPa", v / 1e3),
        v => format!("{v:.3} Pa"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_at_its_limit_is_undecided_even_where_it_is_required() {
        let of = |excess| Judged {
            excess,
            field: "max_stress",
            text: "too large".into(),
        };
        let undecided = of(5e-5).told(true).unwrap();
        assert!(!undecided.is_error() && undecided.message.contains("cannot be told"));
        assert!(of(-0.1).told(true).is_none());
        assert!(of(0.1).told(true).unwrap().is_error());
        assert!(!of(0.1).told(false).unwrap().is_error());
    }

    #[test]
    fn stresses_have_a_unit_that_fits() {
        assert_eq!(pascals(12.0), "12.000 Pa");
        assert_eq!(pascals(4_963.2), "4.963 kPa");
        assert_eq!(pascals(8e6), "8.000 MPa");
    }
}
