//! Named, placed bodies: what a file of solids holds.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{Affine3, Bounds3, Mesh, MeshTopology, Point3};
use crate::budget;

/// Bodies, and the places where they stand. A body that stands in many places is held once.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// The bodies.
    pub bodies: Vec<Arc<Body>>,
    /// What they are made of.
    pub materials: Vec<Material>,
    /// Pictures on them.
    pub images: Vec<Image>,
    /// What stands where; each is an object of its own in files that know objects.
    pub parts: Vec<Part>,
    /// What its only body was cut out of, where that is known; none once anything was put to it.
    pub cut: Option<Arc<Cut>>,
}

/// A body as what is left of another one, so that several such cuts of one whole can be made at once: A∖B ∩ A∖C is
/// A∖(B∪C), which has no faces that lie on one another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cut {
    /// What it was cut out of.
    pub whole: Mesh,
    /// What was taken away.
    pub taken: Vec<Mesh>,
}

/// Bytes that a triangle of a mesh takes with its share of corners, while it is worked with.
pub(super) const TRIANGLE: usize = 100;

/// Bytes for a part, with those of its copy in a file, and steps.
const PART: usize = 2 * size_of::<Part>();
const PART_STEPS: u64 = 10;

/// A mesh, and where its corners lie on a picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// The triangles.
    pub mesh: Mesh,
    /// For the corners of each triangle the place on the picture, from its upper left corner (0, 0) to its lower right
    /// one (1, 1); as many as there are triangles.
    pub uv: Option<Vec<[[f32; 2]; 3]>>,
    /// A quantity shown by colours, which count before those of materials.
    pub coloring: Option<Coloring>,
}

/// A quantity on a body, shown by colours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coloring {
    /// For each corner of the mesh its sRGB colour.
    pub corners: Vec<[u8; 3]>,
    /// What is shown.
    pub quantity: Arc<str>,
    /// Its unit.
    pub unit: Arc<str>,
    /// The values of the first and of the last colour of the scale; what is beyond has the last one.
    pub range: [f64; 2],
    /// The colours of the scale, at equal steps.
    pub scale: Vec<[u8; 3]>,
}

impl Body {
    /// A mesh without a picture or colours.
    pub fn plain(mesh: Mesh) -> Body {
        Body {
            mesh,
            uv: None,
            coloring: None,
        }
    }

    /// The image under `map`; where it mirrors, the triangles are turned over with the places on their picture.
    pub fn transformed(&self, map: &Affine3) -> Body {
        let mirrored = map.determinant() < 0.0;
        let turned = |&[a, b, c]: &[[f32; 2]; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
        Body {
            mesh: self.mesh.transformed(map),
            uv: self.uv.as_ref().map(|uv| uv.iter().map(turned).collect()),
            coloring: self.coloring.clone(),
        }
    }
}

/// A body in its place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Its name in files.
    pub name: Arc<str>,
    /// The name of the group that it belongs to, such as a layer.
    pub group: Option<Arc<str>>,
    /// Number of the body.
    pub body: u32,
    /// Number of the material.
    pub material: Option<u32>,
    /// Where it stands.
    pub place: Affine3,
}

/// What a thing looks like: a physically based material as glTF has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Its name in files.
    pub name: Arc<str>,
    /// The sRGB colour, which the picture is multiplied with.
    pub color: [u8; 3],
    /// From 0, not seen, to 1.
    pub opacity: f64,
    /// From 0 to 1, a metal.
    pub metallic: f64,
    /// From 0, a mirror, to 1.
    pub roughness: f64,
    /// Number of the picture.
    pub image: Option<u32>,
}

/// A picture as it stands in its file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// The format.
    pub format: ImageFormat,
    /// The bytes of the file.
    pub bytes: Arc<[u8]>,
}

/// The formats of pictures on bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ImageFormat {
    /// PNG.
    Png,
    /// JPEG.
    Jpeg,
}

impl Material {
    /// A dull material of this sRGB colour.
    pub fn of(name: impl Into<Arc<str>>, color: [u8; 3]) -> Material {
        Material {
            name: name.into(),
            color,
            opacity: 1.0,
            metallic: 0.0,
            roughness: 0.7,
            image: None,
        }
    }
}

impl Model {
    /// One part.
    pub fn of(name: impl Into<Arc<str>>, mesh: Mesh) -> Model {
        let mut model = Model::default();
        model.push(name, mesh);
        model
    }

    /// Adds a part that stands where its mesh is.
    pub fn push(&mut self, name: impl Into<Arc<str>>, mesh: Mesh) -> &mut Part {
        let body = self.add_body(Body::plain(mesh));
        self.place(name, body, Affine3::IDENTITY)
    }

    /// Adds a body that no part has yet, and gives its number.
    pub fn add_body(&mut self, body: impl Into<Arc<Body>>) -> u32 {
        self.cut = None;
        self.bodies.push(body.into());
        (self.bodies.len() - 1) as u32
    }

    /// Adds a material, or finds an equal one, and gives its number.
    pub fn add_material(&mut self, material: Material) -> u32 {
        let known = self.materials.iter().position(|m| *m == material);
        known.unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        }) as u32
    }

    /// Adds a part: a known body, placed.
    pub fn place(&mut self, name: impl Into<Arc<str>>, body: u32, place: Affine3) -> &mut Part {
        self.cut = None;
        self.parts.push(Part {
            name: name.into(),
            group: None,
            body,
            material: None,
            place,
        });
        self.parts.last_mut().expect("a part was pushed")
    }

    /// Adds the parts of `other`, each moved by `place`; bodies stay shared.
    pub fn append(&mut self, other: &Model, place: &Affine3) {
        let bodies: Vec<u32> = other.bodies.iter().map(|body| self.share(body)).collect();
        self.cut = None;
        let first_image = self.images.len() as u32;
        self.images.extend(other.images.iter().cloned());
        let moved = |m: &Material| Material {
            image: m.image.map(|i| i + first_image),
            ..m.clone()
        };
        let materials: Vec<u32> = other
            .materials
            .iter()
            .map(|m| self.add_material(moved(m)))
            .collect();
        budget::hold("parts", self.parts.len() + other.parts.len(), PART);
        budget::spend("parts", PART_STEPS * other.parts.len() as u64);
        self.parts.extend(other.parts.iter().map(|part| Part {
            body: bodies[part.body as usize],
            material: part.material.map(|m| materials[m as usize]),
            place: part.place.then(place),
            ..part.clone()
        }));
    }

    /// The number of `body`, which is added if it is not held yet.
    fn share(&mut self, body: &Arc<Body>) -> u32 {
        match self
            .bodies
            .iter()
            .position(|known| Arc::ptr_eq(known, body))
        {
            Some(known) => known as u32,
            None => self.add_body(body.clone()),
        }
    }

    /// The mesh of a part where it stands.
    pub fn mesh(&self, part: &Part) -> Mesh {
        self.bodies[part.body as usize]
            .mesh
            .transformed(&part.place)
    }

    /// All parts as one mesh; nothing is joined.
    pub fn merged(&self) -> Mesh {
        budget::make("triangles", self.triangle_count(), TRIANGLE);
        let mut mesh = Mesh::default();
        self.parts
            .iter()
            .for_each(|part| mesh.append(&self.mesh(part)));
        mesh
    }

    /// The number of triangles of all parts.
    pub fn triangle_count(&self) -> usize {
        self.parts
            .iter()
            .map(|part| self.bodies[part.body as usize].mesh.triangles.len())
            .sum()
    }

    /// The box of all parts.
    pub fn bounds(&self) -> Bounds3 {
        let corners = |part: &Part| -> Bounds3 {
            let mesh = &self.bodies[part.body as usize].mesh;
            Bounds3::of(mesh.positions.iter().map(|p| part.place.apply(*p)))
        };
        self.parts
            .iter()
            .fold(Bounds3::EMPTY, |bounds, part| bounds.union(corners(part)))
    }

    /// The sum of the topologies of all parts.
    pub fn topology(&self) -> MeshTopology {
        let bodies: Vec<MeshTopology> = self
            .bodies
            .iter()
            .map(|body| body.mesh.topology())
            .collect();
        let empty = MeshTopology {
            genus: Some(0),
            ..MeshTopology::default()
        };
        self.parts
            .iter()
            .map(|part| bodies[part.body as usize])
            .fold(empty, |sum, t| MeshTopology {
                components: sum.components + t.components,
                open_edges: sum.open_edges + t.open_edges,
                bad_edges: sum.bad_edges + t.bad_edges,
                pinches: sum.pinches + t.pinches,
                genus: sum.genus.zip(t.genus).map(|(a, b)| a + b),
            })
    }

    /// The sum of the volumes of all parts.
    pub fn volume(&self) -> f64 {
        let of = |part: &Part| {
            self.bodies[part.body as usize].mesh.volume() * part.place.determinant().abs()
        };
        self.parts.iter().map(of).sum()
    }

    /// The sum of the areas of all parts.
    pub fn area(&self) -> f64 {
        self.parts.iter().map(|part| self.mesh(part).area()).sum()
    }

    /// The same things, each moved by `map`.
    pub fn transformed(&self, map: &Affine3) -> Model {
        let moved = |part: &Part| Part {
            place: part.place.then(map),
            ..part.clone()
        };
        Model {
            parts: self.parts.iter().map(moved).collect(),
            cut: None,
            ..self.clone()
        }
    }

    /// Leaves out what is shown by colours.
    pub fn without_colors(&mut self) {
        for body in self
            .bodies
            .iter_mut()
            .filter(|body| body.coloring.is_some())
        {
            Arc::make_mut(body).coloring = None;
        }
    }

    /// Scaled uniformly about the origin.
    pub fn scaled(&self, factor: f64) -> Model {
        self.transformed(&Affine3::scale(Point3::new(factor, factor, factor)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::tetrahedron;
    use super::*;

    #[test]
    fn bodies_and_materials_are_shared() {
        let mut one = Model::of("a", tetrahedron());
        let red = one.add_material(Material::of("red", [255, 0, 0]));
        one.parts[0].material = Some(red);
        let mut all = Model::default();
        all.append(&one, &Affine3::IDENTITY);
        all.append(&one, &Affine3::scale(Point3::new(-2.0, 1.0, 1.0)));
        assert_eq!(
            (all.bodies.len(), all.materials.len(), all.parts.len()),
            (1, 1, 2)
        );
        assert!((all.volume() - 0.5).abs() < 1e-12 && (all.merged().volume() - 0.5).abs() < 1e-12);
        assert_eq!(all.topology().components, 2);
        assert_eq!(all.bounds(), all.merged().bounds());
        assert_eq!(all.triangle_count(), 8);
        assert!((all.scaled(2.0).volume() - 4.0).abs() < 1e-12);
    }
}
