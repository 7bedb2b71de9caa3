//! Meshes as bytes: what a scene's bodies were made of, so that no mesh file is needed to make them again.

use std::sync::Arc;

use sprung::build::Mesh;
use sprung::build::mesh::{Faces, MeshGroup};
use sprung::{Code, DVec3, Error, Result};

use super::{Pack, Unpack};

impl Pack {
    /// A count, and for each mesh the name of its file and what it holds.
    pub fn meshes(&mut self, meshes: &[(String, Arc<Mesh>)]) -> &mut Self {
        self.u64(meshes.len() as u64);
        meshes.iter().fold(self, |pack, (name, mesh)| pack.text(name).mesh(mesh))
    }

    fn mesh(&mut self, mesh: &Mesh) -> &mut Self {
        let Mesh { positions, faces, lines, tetrahedra, groups, colours, warnings } = mesh;
        let positions: Vec<f64> = positions.iter().flat_map(|place| place.to_array()).collect();
        self.f64s(&positions);
        let lengths: Vec<u32> = faces.iter().map(|face| face.len() as u32).collect();
        let corners: Vec<u32> = faces.iter().flatten().copied().collect();
        self.u32s(&lengths).u32s(&corners);
        self.u32s(lines.as_flattened()).u32s(tetrahedra.as_flattened());
        self.u64(groups.len() as u64);
        groups.iter().for_each(|group| {
            self.text(&group.name).u32s(&group.vertices);
        });
        self.f32s(colours.as_flattened()).u64(warnings.len() as u64);
        warnings.iter().fold(self, |pack, warning| pack.text(warning))
    }
}

impl Unpack<'_> {
    /// Meshes that are sound.
    ///
    /// # Errors
    /// [`Code::Unreadable`], and as [`Mesh::check`].
    pub fn meshes(&mut self) -> Result<Vec<(String, Arc<Mesh>)>> {
        let mut meshes = Vec::new();
        for _ in 0..self.u64()? {
            let name = self.text()?.to_owned();
            meshes.push((name, Arc::new(self.mesh()?)));
        }
        Ok(meshes)
    }

    fn mesh(&mut self) -> Result<Mesh> {
        let positions = groups_of::<f64, 3>(&self.f64s()?)?.into_iter().map(DVec3::from_array).collect();
        let faces = faces(&self.u32s()?, &self.u32s()?)?;
        let lines = groups_of(&self.u32s()?)?;
        let tetrahedra = groups_of(&self.u32s()?)?;
        let mut groups = Vec::new();
        for _ in 0..self.u64()? {
            groups.push(MeshGroup { name: self.text()?.to_owned(), vertices: self.u32s()? });
        }
        let colours = groups_of(&self.f32s()?)?;
        let mut warnings = Vec::new();
        for _ in 0..self.u64()? {
            warnings.push(self.text()?.to_owned());
        }
        let mesh = Mesh { positions, faces, lines, tetrahedra, groups, colours, warnings };
        mesh.check().map(|()| mesh)
    }
}

fn faces(lengths: &[u32], mut corners: &[u32]) -> Result<Faces> {
    let mut faces = Faces::default();
    for &length in lengths {
        let (face, rest) = corners.split_at_checked(length as usize).ok_or_else(uneven)?;
        faces.push(face);
        corners = rest;
    }
    if corners.is_empty() { Ok(faces) } else { Err(uneven()) }
}

fn groups_of<T: Copy, const N: usize>(values: &[T]) -> Result<Vec<[T; N]>> {
    let (groups, rest) = values.as_chunks();
    if rest.is_empty() { Ok(groups.to_vec()) } else { Err(uneven()) }
}

fn uneven() -> Error {
    Error::new(Code::Unreadable, "holds a mesh whose counts do not fit each other")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meshes() -> Vec<(String, Arc<Mesh>)> {
        let mut faces = Faces::default();
        faces.push(&[0, 1, 2]);
        faces.push(&[3, 2, 1, 0]);
        let positions = vec![DVec3::ZERO, DVec3::new(0.1, -0.0, 1e-300), DVec3::Y, DVec3::ONE];
        let mesh = Mesh {
            positions,
            faces,
            lines: vec![[0, 3]],
            tetrahedra: vec![[0, 1, 2, 3]],
            groups: vec![MeshGroup { name: "rail".into(), vertices: vec![1, 3] }],
            colours: vec![[1.0, 0.5, 0.0]; 4],
            warnings: vec!["is odd".into()],
        };
        let lone = Mesh { positions: vec![DVec3::Z], ..Mesh::default() };
        vec![("a/b.obj".into(), Arc::new(mesh)), ("c.ply".into(), Arc::new(lone))]
    }

    #[test]
    fn meshes_are_read_as_they_were_and_cut_nowhere() {
        let mut pack = Pack::new();
        let bytes = pack.meshes(&meshes()).clone().into_bytes();
        let mut read = Unpack::new(&bytes);
        assert_eq!(read.meshes(), Ok(meshes()));
        assert_eq!(read.end(), Ok(()));
        for length in 0..bytes.len() {
            assert!(Unpack::new(&bytes[..length]).meshes().is_err(), "{length} bytes");
        }
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        let refused = |change: &dyn Fn(&mut Mesh)| {
            let mut meshes = meshes();
            change(Arc::make_mut(&mut meshes[0].1));
            Unpack::new(&Pack::new().meshes(&meshes).clone().into_bytes()).meshes().is_err()
        };
        assert!(refused(&|mesh| mesh.positions[2].x = f64::NAN));
        assert!(refused(&|mesh| mesh.faces.push(&[0, 1, 4])));
        assert!(refused(&|mesh| mesh.faces.push(&[])));
        assert!(refused(&|mesh| mesh.lines.push([0, 9])));
        assert!(refused(&|mesh| mesh.groups[0].vertices.push(4)));
        assert!(refused(&|mesh| mesh.colours.truncate(1)));
        assert!(faces(&[3, 2], &[0, 1, 2, 3]).is_err() && faces(&[3], &[0, 1, 2, 3]).is_err());
        assert!(groups_of::<u32, 4>(&[0, 1, 2]).is_err());
    }
}
