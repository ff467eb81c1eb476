//! Buildings as triangles, and what is measured on them. All lengths are in metres, z up.
//!
//! - [`TriangleMesh`], [`City`]: the data.
//! - [`repair`]: what is wrong with a mesh, and the repair that measuring needs.
//! - [`SectionProfile`]: the area A(z) of horizontal sections, exact, without a bottom face.
//! - [`clip_to_slabs`]: the parts of a mesh between horizontal planes.
//! - [`section_lid`], [`closing_lid`]: a horizontal section as triangles, and what of it closes a cut.
//! - [`Painted`]: what a triangle looks like, for what is read off facades.
//! - [`SideView`], [`BoxTexture`]: what is seen of a box from its sides and from above; box mapping.
//! - [`OrientedBox`]: the smallest rectangle around a plan, extruded.
//! - [`merge_coplanar`]: the same surface with fewer triangles.
//! - [`VolumeRaster`]: columns of solid material on a square grid; volumetric intersection over union.
//! - [`SurfaceDistance`]: exact distances from points to triangles.

mod bounded;
mod box_texture;
mod city;
mod clip;
mod coplanar;
mod distance;
mod lid;
mod mesh;
mod oriented_box;
mod painted;
mod profile;
mod raster;
mod repair;
mod side_view;
mod triangulate;

pub use bounded::bounded_triangles;
pub use box_texture::{BoxTexture, box_coordinates, box_view};
pub use city::{City, CityBuilding, Part};
pub use clip::clip_to_slabs;
pub use coplanar::merge_coplanar;
pub use distance::{SurfaceDistance, point_triangle_distance, surface_samples};
pub use lid::{closing_lid, section_lid};
pub use mesh::{Corners, TriangleMesh, normal, plan_area};
pub use oriented_box::{OrientedBox, convex_hull};
pub use painted::{Painted, Surface, Texture, corner_bits, grey};
pub use profile::SectionProfile;
pub use raster::{Overlap, VolumeRaster, height_map, solid_intervals};
pub use repair::{MeshFaults, repair};
pub use side_view::{SideView, TOP, VIEWS, view_size};
pub use triangulate::polygon_triangles;
