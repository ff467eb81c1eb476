//! Geometries of CityJSON as triangles, painted where openings are named.

use std::borrow::Cow;
use std::sync::Arc;

use serde_json::Value;

use super::CityError;
use edifice_shape::triangles::{Painted, Surface, TriangleMesh, polygon_triangles};

/// Greys of openings and of everything else.
const OPENING: u8 = 40;
const WALL: u8 = 220;

/// The grey of each kind of surface of a geometry, if windows are among them: what a drawing of the building would show.
fn greys(geometry: &Value) -> Vec<Arc<Surface>> {
    let kinds = geometry.pointer("/semantics/surfaces");
    let kinds = kinds.and_then(Value::as_array).into_iter().flatten();
    let names: Vec<&str> = kinds
        .map(|k| k.get("type").and_then(Value::as_str).unwrap_or_default())
        .collect();
    if !names.contains(&"Window") {
        return Vec::new();
    }
    let grey = |name: &&str| match *name {
        "Window" | "Door" => OPENING,
        _ => WALL,
    };
    let surface = |name| Arc::new(Surface::Plain([grey(name); 3]));
    names.iter().map(surface).collect()
}

/// An object as it is drawn.
pub(super) struct Drawing<'a> {
    vertices: Cow<'a, [[f64; 3]]>,
    /// The paint of the surfaces of each kind.
    kinds: Vec<Arc<Surface>>,
    pub(super) mesh: TriangleMesh,
    pub(super) paint: Vec<Painted>,
}

impl<'a> Drawing<'a> {
    /// Nothing yet, of a geometry with these vertices.
    pub(super) fn new(geometry: &Value, vertices: Cow<'a, [[f64; 3]]>) -> Self {
        Self {
            vertices,
            kinds: greys(geometry),
            mesh: TriangleMesh::default(),
            paint: Vec::new(),
        }
    }

    /// Surfaces at any depth of nesting: a surface is a list of rings, a ring a list of indices. `kinds` are nested in the
    /// same way, down to one for each surface.
    pub(super) fn surfaces(
        &mut self,
        value: &Value,
        kinds: Option<&Value>,
    ) -> std::result::Result<(), CityError> {
        let wrong = || CityError::Format("boundaries are not nested lists of indices".to_owned());
        let list = value.as_array().ok_or_else(wrong)?;
        let is_surface = list
            .first()
            .and_then(Value::as_array)
            .and_then(|ring| ring.first())
            .is_some_and(Value::is_number);
        if !is_surface {
            let own = |i: usize| kinds.and_then(|k| k.get(i));
            let mut inner = list.iter().enumerate();
            return inner.try_for_each(|(i, inner)| self.surfaces(inner, own(i)));
        }
        let mut rings: Vec<Vec<[f64; 3]>> = Vec::new();
        for ring in list {
            let mut corners = Vec::new();
            for index in ring.as_array().ok_or_else(wrong)? {
                let index = index.as_u64().ok_or_else(wrong)?;
                let count = self.vertices.len();
                let vertex = usize::try_from(index).ok();
                let vertex = vertex.and_then(|i| self.vertices.get(i));
                corners.push(*vertex.ok_or(CityError::Dangling { index, count })?);
            }
            rings.push(corners);
        }
        let kind = kinds.and_then(Value::as_u64);
        let kind = kind.and_then(|k| usize::try_from(k).ok());
        let surface = kind.and_then(|k| self.kinds.get(k)).cloned();
        for corners in polygon_triangles(&rings) {
            self.mesh.push(corners);
            self.paint.extend(surface.clone().map(|surface| Painted {
                corners,
                uv: [[0.0; 2]; 3],
                surface,
            }));
        }
        Ok(())
    }
}
