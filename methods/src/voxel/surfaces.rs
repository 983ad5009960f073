//! What the surfaces of a scene are, in the integers that voxels add up.

use twinlight_core::kernels::sum_voxels::{ALBEDO_ONE, CLAMP, NONE, NORMAL_ONE, VoxelSurface, texel_word};
use twinlight_core::scene::{
    CompiledScene, HAS_NORMALS, HAS_TEXCOORDS, MATERIAL_OPAQUE, MaterialRecord, Triangle, TriangleAttributes,
};

/// Texels that a triangle may span: what the integers of [`VoxelSurface::texcoords`] hold.
const MAX_SPAN: f32 = 1000.0;

/// Units of a texture coordinate per texel.
const TEXEL: f32 = 64.0;

/// The surfaces of a scene's triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct VoxelSurfaces {
    /// One per triangle.
    pub surfaces: Vec<VoxelSurface>,
    /// Texels of all levels of all textures.
    pub texels: Vec<u32>,
    /// Radiance per unit of emission.
    pub emission_unit: f32,
}

/// A texture, ever smaller.
struct Texture {
    offset: u32,
    levels: Vec<Level>,
}

#[derive(Clone, Copy)]
struct Level {
    first: u32,
    width: u32,
    height: u32,
}

/// The surfaces of a scene for voxels `voxel` wide, world units. A texture is read at the level whose texels are next as wide, so that no
/// detail is aliased.
pub fn surfaces(scene: &CompiledScene, voxel: f32) -> VoxelSurfaces {
    let brightest =
        scene.materials.iter().flat_map(|m| m.emission).fold(0.0_f32, |a, b| if b > a { b } else { a });
    let emission_unit = if brightest > 0.0 { brightest / 4095.0 } else { 1.0 };
    let mut texels = Vec::new();
    let mut textures: Vec<Texture> = Vec::new();
    for material in &scene.materials {
        let known = textures.iter().any(|t| t.offset == material.texture_offset);
        if material.texture_offset != NONE && !known {
            textures.push(Texture::of(scene, material, &mut texels));
        }
    }
    let surface = |(triangle, attributes): (&Triangle, &TriangleAttributes)| {
        let material = &scene.materials[triangle.material as usize];
        let texture = textures.iter().find(|t| t.offset == material.texture_offset);
        surface_of(triangle, attributes, material, texture, voxel, emission_unit)
    };
    let surfaces = scene.triangles.iter().zip(&scene.attributes).map(surface).collect();
    VoxelSurfaces { surfaces, texels, emission_unit }
}

fn surface_of(
    triangle: &Triangle,
    attributes: &TriangleAttributes,
    material: &MaterialRecord,
    texture: Option<&Texture>,
    voxel: f32,
    emission_unit: f32,
) -> VoxelSurface {
    let has_normals = attributes.flags & HAS_NORMALS != 0;
    let corner = |normal: [f32; 3]| normal_word(if has_normals { normal } else { triangle.normal });
    let reflected = mean_reflectance(material);
    // Light is scattered that is reflected neither on the way in nor out. Mirrors and glass scatter none.
    let scattered = |c: usize| material.albedo[c] * ((1.0 - reflected[c]) * (1.0 - reflected[c]));
    let albedo = if material.kind == MATERIAL_OPAQUE { [0, 1, 2].map(scattered) } else { [0.0; 3] };
    let mut surface = VoxelSurface {
        normals: [attributes.n0, attributes.n1, attributes.n2].map(corner),
        texture: NONE,
        texcoords: [[0; 2]; 3],
        texture_size: 1 | 1 << 16,
        flags: if material.texture_wrap == 1 { CLAMP } else { 0 },
        tint: halves(albedo.map(|a| a * ALBEDO_ONE as f32)),
        emission: halves(material.emission.map(|e| e / emission_unit)),
    };
    if let Some(texture) = texture.filter(|_| attributes.flags & HAS_TEXCOORDS != 0) {
        let uv = [attributes.uv0, attributes.uv1, [attributes.uv2_u, attributes.uv2_v]];
        texture.put(&mut surface, uv, longest_side(triangle) / voxel);
    }
    surface
}

/// Schlick's reflectance of light from all sides: the mean of (1 − cos)⁵ weighed by the cosine is 1/21.
pub(super) fn mean_reflectance(material: &MaterialRecord) -> [f32; 3] {
    material.specular_f0.map(|f0| f0 + (material.specular_f90 - f0) * (1.0 / 21.0))
}

/// 12 bits each.
fn halves(values: [f32; 3]) -> [u32; 2] {
    // Saturates, and makes 0 of what is no number.
    let [r, g, b] = values.map(|v| ((v + 0.5) as u32).min(ALBEDO_ONE));
    [r | g << 16, b]
}

fn normal_word(normal: [f32; 3]) -> u32 {
    let [x, y, z] = normal.map(|c| {
        let scaled = (c * NORMAL_ONE as f32).round_ties_even() as i32;
        u32::from(scaled.clamp(-NORMAL_ONE, NORMAL_ONE) as i8 as u8)
    });
    x | y << 8 | z << 16
}

/// World units.
fn longest_side(triangle: &Triangle) -> f32 {
    let p = [triangle.p0, triangle.p1, triangle.p2].map(glam::Vec3::from);
    let squared = [p[1] - p[0], p[2] - p[1], p[0] - p[2]].map(|side| side.dot(side));
    squared.into_iter().fold(0.0_f32, |a, b| if b > a { b } else { a }).sqrt()
}

impl Texture {
    /// Reads a material's texture and halves it down to one texel.
    fn of(scene: &CompiledScene, material: &MaterialRecord, texels: &mut Vec<u32>) -> Self {
        let decode = |byte: u32| f32::from_bits(scene.words[byte as usize]);
        let (mut width, mut height) = (material.texture_width, material.texture_height);
        let begin = material.texture_offset as usize;
        let words = &scene.words[begin..begin + width as usize * height as usize];
        let mut rgb: Vec<[f32; 3]> = words
            .iter()
            .map(|word| [decode(word & 255), decode(word >> 8 & 255), decode(word >> 16 & 255)])
            .collect();
        let mut levels = Vec::new();
        loop {
            levels.push(Level { first: texels.len() as u32, width, height });
            texels
                .extend(rgb.iter().map(|rgb| texel_word(rgb.map(|c| ((c * 1023.0 + 0.5) as u32).min(1023)))));
            if width == 1 && height == 1 {
                return Self { offset: material.texture_offset, levels };
            }
            rgb = halved(&rgb, width, height);
            (width, height) = (width.div_ceil(2), height.div_ceil(2));
        }
    }

    /// Sets a surface's texture, for a triangle that is `size` voxels long.
    fn put(&self, surface: &mut VoxelSurface, uv: [[f32; 2]; 3], size: f32) {
        let clamps = surface.flags & CLAMP != 0;
        // Whole tiles are the same texels.
        let base = [0, 1].map(|i| if clamps { 0.0 } else { uv[0][i].floor() });
        let uv = uv.map(|[u, v]| [u - base[0], v - base[1]]);
        let extent = |level: &Level| {
            let span = |i: usize, n: u32| {
                let (low, high) =
                    uv.iter().fold((0.0_f32, 0.0_f32), |(low, high), p| (low.min(p[i]), high.max(p[i])));
                (high - low) * n as f32
            };
            span(0, level.width).max(span(1, level.height))
        };
        let fits = |level: &&Level| extent(level) <= MAX_SPAN && extent(level) <= size.max(1.0) * 1.5;
        let level = self.levels.iter().find(fits).or(self.levels.last());
        let Some(&level) = level else { return };
        surface.texture = level.first;
        surface.texture_size = level.width | level.height << 16;
        if extent(&level) <= MAX_SPAN {
            let place = |p: [f32; 2]| {
                [(p[0] * level.width as f32 * TEXEL) as i32, (p[1] * level.height as f32 * TEXEL) as i32]
            };
            surface.texcoords = uv.map(place);
        }
    }
}

/// The means of two by two texels; the last row and column stand for those beyond.
fn halved(rgb: &[[f32; 3]], width: u32, height: u32) -> Vec<[f32; 3]> {
    let (width, height) = (width as usize, height as usize);
    let at = |x: usize, y: usize| rgb[y.min(height - 1) * width + x.min(width - 1)];
    let mut half = Vec::with_capacity(width.div_ceil(2) * height.div_ceil(2));
    for y in (0..height).step_by(2) {
        for x in (0..width).step_by(2) {
            let four = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
            half.push([0, 1, 2].map(|c| (four[0][c] + four[1][c] + four[2][c] + four[3][c]) * 0.25));
        }
    }
    half
}
