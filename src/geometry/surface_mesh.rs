//! Surfaces as nodes give them: a triangle mesh, and how it came about where that says how a drawing can be laid on it
//! without guessing. How one is laid is known to the room `wrap`.

use std::ops::Deref;

use serde::{Deserialize, Serialize};

use crate::mesh::{self, RevolveError};
use crate::{Mesh, Point, Point3};

/// A mesh with its form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceMesh {
    /// The triangles.
    pub mesh: Mesh,
    /// How they came about.
    pub form: Form,
}

/// How a surface came about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Form {
    /// In a way that says nothing of its shape.
    Free,
    /// A profile that was turned about the z axis.
    Turned(Turned),
    /// A curve that was moved upward.
    Swept(Swept),
}

/// A profile turned about the z axis in flat pieces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Turned {
    /// Radius and height of its points, in the order in which the surface faces outward.
    pub profile: Vec<Point>,
    /// The last point is joined to the first.
    pub closed: bool,
    /// How many pieces a full turn has.
    pub segments: u32,
}

/// A level curve moved along z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Swept {
    /// The points of the curve as seen from above, counter-clockwise where it is closed; the first is not repeated.
    pub points: Vec<Point>,
    /// The last point is joined to the first.
    pub closed: bool,
    /// From where to where it is moved.
    pub heights: [f64; 2],
}

impl Deref for SurfaceMesh {
    type Target = Mesh;

    fn deref(&self) -> &Mesh {
        &self.mesh
    }
}

impl From<Mesh> for SurfaceMesh {
    fn from(mesh: Mesh) -> SurfaceMesh {
        SurfaceMesh {
            mesh,
            form: Form::Free,
        }
    }
}

impl SurfaceMesh {
    /// The surface that [`mesh::revolve`] gives, with its profile.
    ///
    /// # Errors
    /// As there.
    pub fn turned(
        profile: &[Point],
        closed: bool,
        segments: u32,
    ) -> Result<SurfaceMesh, RevolveError> {
        let mesh = mesh::revolve(profile, closed, segments)?;
        let profile = mesh::revolved_profile(profile, closed, segments)?;
        let form = Form::Turned(Turned {
            profile,
            closed,
            segments,
        });
        Ok(SurfaceMesh { mesh, form })
    }

    /// The wall on a curve: open at the top and the bottom, facing to the right of an open curve and outward on a closed
    /// one. Points that repeat their predecessor count once. None for fewer than two points, three where it is closed, and
    /// for heights that are not above one another.
    ///
    /// ```
    /// use fretwork_geometry::{Point, SurfaceMesh};
    /// let plan = [[0.0, 0.0], [0.0, 2.0], [3.0, 2.0], [3.0, 0.0]].map(Point::from);
    /// let wall = SurfaceMesh::swept(&plan, true, [0.0, 5.0]).unwrap();
    /// assert_eq!(wall.triangles.len(), 8);
    /// assert!((wall.area() - 50.0).abs() < 1e-12 && wall.volume() > 0.0);
    /// ```
    pub fn swept(plan: &[Point], closed: bool, heights: [f64; 2]) -> Option<SurfaceMesh> {
        let mut points = plan.to_vec();
        points.dedup();
        while closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        let is_sound = heights[0] < heights[1] && points.iter().all(|p| p.is_finite());
        if points.len() < 2 + usize::from(closed) || !is_sound {
            return None;
        }
        if closed && crate::polygon::signed_area(&points) < 0.0 {
            points.reverse();
        }
        let count = points.len() as u32;
        let at = |z: f64| points.iter().map(move |p| Point3::new(p.x, p.y, z));
        let positions = at(heights[0]).chain(at(heights[1])).collect();
        let columns = if closed { count } else { count - 1 };
        let column = |j: u32| {
            let (a, b) = (j, (j + 1) % count);
            [[a, b, b + count], [a, b + count, a + count]]
        };
        let mesh = Mesh {
            positions,
            triangles: (0..columns).flat_map(column).collect(),
        };
        let form = Form::Swept(Swept {
            points,
            closed,
            heights,
        });
        Some(SurfaceMesh { mesh, form })
    }
}
