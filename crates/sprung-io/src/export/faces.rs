//! Faces as they leave: triangles, and the polygons of an artist's mesh, which are fans of them.

use super::Geometry;
use super::geometry::Part;

/// A face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face<'a> {
    /// The triangles that it is, around its first corner.
    fan: &'a [[u32; 3]],
    /// What is added to the number of each corner.
    first: u32,
}

impl<'a> Face<'a> {
    /// How many corners it has.
    pub fn len(self) -> usize {
        self.fan.len() + 2
    }

    /// Its corners in turn.
    pub fn corners(self) -> impl Iterator<Item = u32> + 'a {
        let begin = self.fan.first().into_iter().flat_map(|&[a, b, _]| [a, b]);
        begin.chain(self.fan.iter().map(|&[.., c]| c)).map(move |corner| self.first + corner)
    }
}

impl Part {
    /// The faces: polygons where the artist's mesh has some, and triangles. Corners count from the part's first vertex.
    pub fn faces(&self) -> impl Iterator<Item = Face<'_>> {
        let (mut rest, mut fans) = (&self.triangles[..], self.fans.iter());
        std::iter::from_fn(move || {
            let length = fans.next().map_or(1, |&fan| fan as usize);
            Some(Face { fan: rest.split_off(..length)?, first: 0 })
        })
    }

    /// How many faces there are.
    pub fn face_count(&self) -> usize {
        if self.fans.is_empty() { self.triangles.len() } else { self.fans.len() }
    }
}

impl Geometry {
    /// How many faces there are, in every frame.
    pub fn face_count(&self) -> usize {
        self.parts().iter().map(Part::face_count).sum()
    }

    /// How many corners all faces have together.
    pub fn corner_count(&self) -> usize {
        self.triangle_count() + 2 * self.face_count()
    }

    /// All faces, their corners as indices into [`positions`](Self::positions).
    pub fn faces(&self) -> impl Iterator<Item = Face<'_>> {
        self.parts().iter().flat_map(|part| {
            let first = part.vertices.start as u32;
            part.faces().map(move |face| Face { first, ..face })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fans_are_polygons() {
        let mut part = Part {
            name: String::new(),
            body: None,
            vertices: 0..7,
            triangles: vec![[0, 1, 2], [3, 4, 5], [3, 5, 6], [2, 1, 6]],
            fans: vec![1, 2, 1],
            is_closed: false,
            colour: [0; 3],
        };
        let corners =
            |part: &Part| part.faces().map(|face| face.corners().collect()).collect::<Vec<Vec<u32>>>();
        assert_eq!(corners(&part), [vec![0, 1, 2], vec![3, 4, 5, 6], vec![2, 1, 6]]);
        assert_eq!(part.face_count(), 3);
        assert!(part.faces().map(Face::len).eq([3, 4, 3]));
        part.fans.clear();
        assert_eq!(corners(&part).concat(), part.triangles.as_flattened());
        assert_eq!(part.face_count(), 4);
    }
}
