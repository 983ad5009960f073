//! What a scene has that light reacts to.

use super::light::{self, Lighting};
use super::sight;
use glam::DVec3;
use twinlight_core::Result;
use twinlight_core::scene::{
    Camera, CompiledScene, HAS_TEXCOORDS, LIGHT_DIRECTIONAL, LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPHERE,
    LIGHT_SPOT, LIGHT_TRIANGLE, MATERIAL_DIELECTRIC, MATERIAL_MIRROR, MATERIAL_OPAQUE, MaterialRecord, NONE,
};

/// A scene, as far as plans depend on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Facts {
    /// Triangles.
    pub triangles: usize,
    /// Of those, the ones that may move.
    pub moving: usize,
    /// Emissive triangles and spheres.
    pub area_lights: usize,
    /// Points, spots and directional lights.
    pub delta_lights: usize,
    /// Whether light comes from the surroundings.
    pub environment: bool,
    /// Triangles with a lobe.
    pub glossy: usize,
    /// Triangles that are mirrors.
    pub mirrors: usize,
    /// Whether any triangle with a lobe, or any mirror, may be in the picture.
    pub shining_in_view: bool,
    /// Triangles of glass.
    pub glass: usize,
    /// Triangles with a texture.
    pub textured: usize,
    /// Most that any surface reflects of what falls on it, over channels and directions; 1 where nothing less is sure.
    pub reflectance: f64,
    /// The surface that [`Facts::reflectance`] is of, in words.
    pub brightest_surface: &'static str,
    /// Mean albedo over the surfaces' areas, for estimates of work.
    pub mean_albedo: f64,
    /// Of all triangles, square world units.
    pub area: f64,
    /// Of the bounds, world units.
    pub longest_side: f64,
    /// Most radiance that a white surface scatters of the lights themselves; infinite where nothing is known.
    pub direct: f64,
    /// Why no surface sees another, or why one may.
    pub sight: sight::Sight,
}

impl Facts {
    /// Looks at a scene, from `camera`.
    ///
    /// # Errors
    /// What the camera refuses.
    pub fn of(scene: &CompiledScene, camera: &Camera, (width, height): (u32, u32)) -> Result<Self> {
        let mut facts = Self {
            triangles: scene.triangles.len(),
            moving: scene.parts().1.len(),
            area_lights: count_lights(scene, &[LIGHT_TRIANGLE, LIGHT_SPHERE]),
            delta_lights: count_lights(scene, &[LIGHT_POINT, LIGHT_SPOT, LIGHT_DIRECTIONAL]),
            environment: count_lights(scene, &[LIGHT_ENVIRONMENT]) > 0,
            glossy: 0,
            mirrors: 0,
            shining_in_view: false,
            glass: 0,
            textured: 0,
            reflectance: 0.0,
            brightest_surface: "no surface reflects anything",
            mean_albedo: 0.0,
            area: 0.0,
            longest_side: longest_side(scene),
            direct: light::most_scattered(scene, &Lighting::default()),
            sight: sight::Sight::Unknown("it was not looked at"),
        };
        facts.look_at_surfaces(scene, camera, (width, height))?;
        facts.sight = sight::of(scene, camera, facts.glass > 0);
        Ok(facts)
    }

    /// Whether anything gives light.
    pub fn has_light(&self) -> bool {
        self.area_lights + self.delta_lights > 0 || self.environment
    }

    fn look_at_surfaces(
        &mut self,
        scene: &CompiledScene,
        camera: &Camera,
        (width, height): (u32, u32),
    ) -> Result<()> {
        let frustum = Frustum::of(camera, (width, height), scene.origin)?;
        let mut areas = vec![0.0_f64; scene.materials.len()];
        let mut has_texcoords = vec![false; scene.materials.len()];
        for (triangle, attributes) in scene.triangles.iter().zip(&scene.attributes) {
            let index = triangle.material as usize;
            let Some(material) = scene.materials.get(index) else { continue };
            let corners = [triangle.p0, triangle.p1, triangle.p2].map(|p| glam::Vec3::from(p).as_dvec3());
            areas[index] += (corners[1] - corners[0]).cross(corners[2] - corners[0]).length() * 0.5;
            has_texcoords[index] |= attributes.flags & HAS_TEXCOORDS != 0;
            match material.kind {
                MATERIAL_MIRROR => self.mirrors += 1,
                MATERIAL_DIELECTRIC => self.glass += 1,
                _ if is_glossy(material) => self.glossy += 1,
                _ => {}
            }
            let shines = material.kind == MATERIAL_MIRROR || is_glossy(material);
            self.shining_in_view = self.shining_in_view || (shines && frustum.may_show(corners));
            if material.texture_offset != NONE && attributes.flags & HAS_TEXCOORDS != 0 {
                self.textured += 1;
            }
        }
        let (mut sum, mut whole) = (0.0, 0.0);
        for ((material, &area), &textured) in scene.materials.iter().zip(&areas).zip(&has_texcoords) {
            // Triangles without area are met by no ray; a material without triangles is nowhere.
            if area > 0.0 {
                self.look_at_material(scene, material, textured);
                sum += area * f64::from(material.albedo.into_iter().sum::<f32>() / 3.0);
                whole += area;
            }
        }
        self.mean_albedo = if whole > 0.0 { sum / whole } else { 0.0 };
        self.area = whole;
        Ok(())
    }

    fn look_at_material(&mut self, scene: &CompiledScene, material: &MaterialRecord, textured: bool) {
        let (most, what) = match material.kind {
            MATERIAL_OPAQUE if is_glossy(material) => {
                // Schlick's reflectance rises to f90 at grazing angles, and what is left is scattered.
                let f90 = f64::from(material.specular_f90);
                (f90 + (1.0 - f90) * most_albedo(scene, material, textured), "glossy at grazing angles")
            }
            MATERIAL_OPAQUE => (most_albedo(scene, material, textured), "diffuse"),
            MATERIAL_MIRROR => (f64::from(material.specular_f0.into_iter().fold(0.0, f32::max)), "a mirror"),
            _ => (1.0, "glass"),
        };
        if most > self.reflectance {
            (self.reflectance, self.brightest_surface) = (most, what);
        }
    }
}

/// Whether a material has a lobe.
pub(super) fn is_glossy(material: &MaterialRecord) -> bool {
    material.kind == MATERIAL_OPAQUE && material.specular_f90 > 0.0
}

fn longest_side(scene: &CompiledScene) -> f64 {
    let (low, high) = scene.bounds;
    (0..3).map(|i| f64::from(high[i]) - f64::from(low[i])).fold(0.0, f64::max)
}

fn count_lights(scene: &CompiledScene, kinds: &[u32]) -> usize {
    let gives = |rgb: [f32; 3]| rgb.into_iter().any(|c| c > 0.0);
    let is_one =
        |kind: u32, emission| kinds.contains(&kind) && (kind == LIGHT_ENVIRONMENT || gives(emission));
    scene.lights.iter().filter(|light| is_one(light.kind, light.emission)).count()
}

/// Texels that are looked at: beyond, a texture counts as white.
const MOST_TEXELS: usize = 1 << 26;

/// Largest albedo over channels and texels.
fn most_albedo(scene: &CompiledScene, material: &MaterialRecord, textured: bool) -> f64 {
    let (begin, len) = (
        material.texture_offset as usize,
        material.texture_width as usize * material.texture_height as usize,
    );
    let mut texel = [255; 3];
    if textured && material.texture_offset != NONE && len <= MOST_TEXELS {
        // Triangles without coordinates have the albedo alone; where some have them, white is among the texels that may be read.
        texel = most_texel(&scene.words[begin..begin + len]);
    }
    let channel = |c: usize| f64::from(material.albedo[c]) * f64::from(f32::from_bits(scene.words[texel[c]]));
    (0..3).map(channel).fold(0.0, f64::max)
}

/// The largest byte of each channel, as places in the table that decodes them.
fn most_texel(words: &[u32]) -> [usize; 3] {
    let most = |shift: u32| words.iter().map(|word| (word >> shift & 255) as usize).max().unwrap_or(255);
    [most(0), most(8), most(16)]
}

/// What a camera may see: the four planes through its eye.
struct Frustum {
    eye: DVec3,
    /// Inwards.
    normals: [DVec3; 4],
}

impl Frustum {
    fn of(camera: &Camera, (width, height): (u32, u32), origin: [f64; 3]) -> Result<Self> {
        let record = camera.record(width, height, origin)?;
        let vector = |v: [f32; 3]| glam::Vec3::from(v).as_dvec3();
        let (corner, x, y) = (vector(record.corner), vector(record.step_x), vector(record.step_y));
        let (right, down) = (x * f64::from(width), y * f64::from(height));
        let corners = [corner, corner + right, corner + right + down, corner + down];
        let middle = corner + (right + down) * 0.5;
        let plane = |i: usize| {
            let normal = corners[i].cross(corners[(i + 1) % 4]);
            if normal.dot(middle) < 0.0 { -normal } else { normal }
        };
        Ok(Self { eye: vector(record.position), normals: [0, 1, 2, 3].map(plane) })
    }

    /// False where a triangle is beyond one of the planes: no pixel shows it.
    fn may_show(&self, corners: [DVec3; 3]) -> bool {
        self.normals.iter().all(|normal| corners.iter().any(|p| normal.dot(*p - self.eye) >= 0.0))
    }
}
