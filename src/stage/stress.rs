//! What was found out about a shell, shown by colours: the stress, and what was added to its pattern.

use std::sync::Arc;

use fretwork_geometry::mesh::{Body, Coloring};
use fretwork_geometry::shell::{AnalysedBody, Reason, Strength};
use fretwork_geometry::{Affine3, Mesh, Model, Shell};

/// From no stress to much, in equal steps: light where nothing acts, dark where it matters.
const SCALE: [[u8; 3]; 6] = [
    [0xe6, 0xec, 0xef],
    [0x9c, 0xc7, 0xd0],
    [0x6f, 0xb0, 0x8f],
    [0xe8, 0xc2, 0x4a],
    [0xe0, 0x7b, 0x32],
    [0xa8, 0x20, 0x2a],
];

/// The pattern, what makes its features wide enough, and bridges.
const REASONS: [[u8; 3]; 3] = [[0xd9, 0xcd, 0xb8], [0xe6, 0xb4, 0x5e], [0xb5, 0x4a, 0x2e]];

/// The body of a shell, coloured where it was analysed. The scale ends with the stress that 99 % of the body
/// stay below.
pub fn colored(name: &Arc<str>, shell: &Shell) -> Model {
    let strength = shell.measures.strength.as_ref();
    under_stress(name, &shell.mesh, (strength, &shell.stress))
}

/// A body that was analysed, coloured in the same way.
pub fn colored_analysis(name: &Arc<str>, body: &AnalysedBody) -> Model {
    under_stress(name, &body.mesh, (Some(&body.strength), &body.stress))
}

fn under_stress(
    name: &Arc<str>,
    mesh: &Mesh,
    (strength, stress): (Option<&Strength>, &[f32]),
) -> Model {
    let mut body = Body::plain(mesh.clone());
    if let Some(strength) = strength {
        let most = strength.stress.p99;
        body.coloring = Some(Coloring {
            corners: stress
                .iter()
                .map(|stress| color(f64::from(*stress), most))
                .collect(),
            quantity: "sum of the absolute principal stresses".into(),
            unit: "Pa".into(),
            range: [0.0, most],
            scale: SCALE.to_vec(),
        });
    }
    placed(name, body)
}

/// The body of a shell, coloured by why it is solid.
pub fn reasoned(name: &Arc<str>, shell: &Shell) -> Model {
    let of = |reason: &Reason| match reason {
        Reason::Pattern => REASONS[0],
        Reason::Feature => REASONS[1],
        Reason::Bridge => REASONS[2],
    };
    placed(
        name,
        Body {
            coloring: Some(Coloring {
                corners: shell.reasons.iter().map(of).collect(),
                quantity: "pattern, widened, bridge".into(),
                unit: "".into(),
                range: [0.0, 2.0],
                scale: REASONS.to_vec(),
            }),
            ..Body::plain(shell.mesh.clone())
        },
    )
}

fn placed(name: &Arc<str>, body: Body) -> Model {
    let mut model = Model::default();
    let number = model.add_body(body);
    model.place(name.clone(), number, Affine3::IDENTITY);
    model
}

fn color(value: f64, most: f64) -> [u8; 3] {
    let last = SCALE.len() - 1;
    let place = if most > 0.0 {
        (value / most).clamp(0.0, 1.0) * last as f64
    } else {
        0.0
    };
    let step = (place as usize).min(last - 1);
    let part = place - step as f64;
    let mix = |a: u8, b: u8| (f64::from(a) * (1.0 - part) + f64::from(b) * part).round() as u8;
    std::array::from_fn(|k| mix(SCALE[step][k], SCALE[step + 1][k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_runs_from_its_first_colour_to_its_last() {
        assert_eq!(color(0.0, 8.0), SCALE[0]);
        assert_eq!(color(8.0, 8.0), SCALE[5]);
        assert_eq!(color(80.0, 8.0), SCALE[5]);
        assert_eq!(color(1.6, 8.0), SCALE[1]);
        assert_eq!(color(1.0, 0.0), SCALE[0]);
    }
}
