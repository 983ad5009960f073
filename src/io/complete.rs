//! Cameras and lights for scenes that come without.

use glam::DVec3;
use std::borrow::Cow;
use twinlight_core::scene::{COORDINATE_LIMIT, Camera, Light, Scene};

/// Side of the made-up light, over its distance from what it lights: large enough for soft shadows.
const LIGHT_SIZE: f64 = 0.2;

/// Least distance to what is lit: a scene that is a single point still gets a light with an area.
const SMALLEST: f64 = 1e-6;

/// Share of the whole area that must be missing on one side for the camera to be placed there. A cube without a side
/// lacks a fifth of what is left; half of that leaves room for as much furniture as walls. Scans that are closed but for
/// small holes stay below it.
const OPEN: f64 = 0.1;

/// Parts of a motion whose ends are framed.
const MOMENTS: u32 = 8;

/// Gives a scene without a camera one that frames it, from its open side if it has one, and a scene without light a
/// rectangle beside the camera, each with a notice.
///
/// The rectangle lies in the plane of the eye, just above it, and faces along the view axis: the eye stands in free
/// space, so the light does too, whether the scene is a single object seen from outside or a closed room seen from inside;
/// and no camera ray can meet it. Its radiance makes a white surface in the middle of the view about as bright as
/// radiance 1.
///
/// Of a scene that moves, what is framed is where it is at a few moments of its motion.
pub fn complete(scene: &mut Scene) {
    let (begin, bounds) = stage(scene);
    if scene.camera.is_none() {
        let (lo, hi) = bounds.unwrap_or((DVec3::NEG_ONE, DVec3::ONE));
        let side = open_side(&begin).unwrap_or(DVec3::Z);
        scene.camera = Some(Camera::framing_from((lo, hi), side));
        scene.notices.push("no camera in the scene: one that frames it is used".into());
    }
    if scene.has_light() || bounds.is_none() {
        return;
    }
    if let (Some(camera), Some(bounds)) = (scene.camera, bounds)
        && let Some(light) = beside_camera(&camera, bounds)
    {
        scene.lights.push(light);
        scene.notices.push("no light in the scene: a rectangle light just above the camera is used".into());
    }
}

/// The scene, or when it moves, its geometry as it begins; and the bounds of what it fills, from the first moment to the last.
fn stage(scene: &Scene) -> (Cow<'_, Scene>, Option<(DVec3, DVec3)>) {
    if scene.motion.is_empty() {
        return (Cow::Borrowed(scene), finite_bounds(scene));
    }
    // Pictures are large and play no part here.
    let geometry = Scene {
        meshes: scene.meshes.clone(),
        instances: scene.instances.clone(),
        motion: scene.motion.clone(),
        ..Scene::default()
    };
    // A motion that does not fit the scene is refused where the scene is posed to be rendered.
    let at = |moment: u32| geometry.at(scene.motion.duration * f64::from(moment) / f64::from(MOMENTS)).ok();
    let bounds = (0..=MOMENTS).filter_map(|moment| finite_bounds(&at(moment)?)).reduce(union);
    (Cow::Owned(at(0).unwrap_or_default()), bounds)
}

fn union((lo, hi): (DVec3, DVec3), (other_lo, other_hi): (DVec3, DVec3)) -> (DVec3, DVec3) {
    (lo.min(other_lo), hi.max(other_hi))
}

fn beside_camera(camera: &Camera, (lo, hi): (DVec3, DVec3)) -> Option<Light> {
    let [eye, target, up] = [camera.position, camera.target, camera.up].map(DVec3::from);
    let forward = (target - eye).try_normalize()?;
    let right = forward.cross(up).try_normalize()?;
    let up = right.cross(forward);
    // A target may be any point on the axis. What is seen is behind the nearest point of the scene, not further than the
    // scene is large; nor is it right at the eye of a camera inside.
    let extent = (hi - lo).length();
    let gap = eye.distance(eye.clamp(lo, hi));
    let distance = eye.distance(target).clamp(gap.max(extent * 0.25), gap + extent).max(SMALLEST);
    let side = LIGHT_SIZE * distance;
    let corner = eye - right * (side * 0.5);
    let narrow = |v: DVec3| v.as_vec3().to_array();
    // A white surface at that distance facing the light reflects L·side²/(π·distance²).
    let radiance = (std::f64::consts::PI / (LIGHT_SIZE * LIGHT_SIZE)) as f32;
    // The front of a rectangle is along edge_u × edge_v, and up × right is forward.
    Some(Light::Rectangle {
        corner: narrow(corner),
        edge_u: narrow(up * side),
        edge_v: narrow(right * side),
        radiance: [radiance; 3],
    })
}

/// Where most faces can be seen from: over the faces of a closed mesh, area times normal adds up to nothing; over those
/// of an open one, to what would close it. So it points out of the open side of a room whose walls face inwards, and
/// away from the missing bottom of an object whose walls face outwards.
fn open_side(scene: &Scene) -> Option<DVec3> {
    let (mut sum, mut area) = (DVec3::ZERO, 0.0);
    for instance in &scene.instances {
        let Some(mesh) = scene.meshes.get(instance.mesh as usize) else { continue };
        // A mirrored placement keeps its front sides in front.
        let sign = instance.transform.determinant().signum();
        for triangle in &mesh.triangles {
            let point = |v: u32| mesh.positions.get(v as usize).map(|&p| instance.transform.point(p));
            let [a, b, c] = triangle.map(|v| point(v).unwrap_or(DVec3::NAN));
            let facing = (b - a).cross(c - a) * (0.5 * sign);
            // What a lenient reader drops later has no side.
            if [a, b, c].into_iter().all(within_limit) {
                sum += facing;
                area += facing.length();
            }
        }
    }
    let side = if sum.length() > OPEN * area { sum.try_normalize() } else { None };
    // Nobody looks from under the ground, and grounds are wound either way.
    side.filter(|side| side.y > -0.9)
}

fn within_limit(p: DVec3) -> bool {
    p.is_finite() && p.abs().max_element() <= COORDINATE_LIMIT
}

/// Bounds of the vertices that are numbers within the limit: a lenient reader lets others pass.
fn finite_bounds(scene: &Scene) -> Option<(DVec3, DVec3)> {
    let mut bounds: Option<(DVec3, DVec3)> = None;
    for instance in &scene.instances {
        let Some(mesh) = scene.meshes.get(instance.mesh as usize) else { continue };
        let points = mesh.positions.iter().map(|&p| instance.transform.point(p));
        for p in points.filter(|&p| within_limit(p)) {
            let (lo, hi) = bounds.unwrap_or((p, p));
            bounds = Some((lo.min(p), hi.max(p)));
        }
    }
    bounds
}
