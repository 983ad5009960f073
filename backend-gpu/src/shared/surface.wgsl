// From a hit to what is shaded. Twin of core/src/transport/surface.rs.

struct CameraRecord {
    position: vec3<f32>,
    padding_a: f32,
    corner: vec3<f32>,
    padding_b: f32,
    step_x: vec3<f32>,
    padding_c: f32,
    step_y: vec3<f32>,
    padding_d: f32,
    forward: vec3<f32>,
    padding_e: f32,
}

struct Surface {
    position: vec3<f32>,
    offset: f32,
    geometric_normal: vec3<f32>,
    shading_normal: vec3<f32>,
    albedo: vec3<f32>,
    material: u32,
    light: u32,
    front: bool,
}

fn camera_direction(camera: CameraRecord, x: f32, y: f32) -> vec3<f32> {
    return normalized(camera.corner + camera.step_x * x + camera.step_y * y);
}

// The surface at barycentric (u, v) of the triangle in `slot`, met by a ray along the unit `direction`.
fn surface_at(slot: u32, u: f32, v: f32, direction: vec3<f32>) -> Surface {
    let record = triangles[slot];
    let record_attributes = attributes[slot];
    let material = materials[record.material];
    let w = (1.0f - u) - v;
    let a = record.p0 * w;
    let b = record.p1 * u;
    let c = record.p2 * v;
    let position = (a + b) + c;
    let front = dot_product(record.normal, direction) < 0.0f;
    let geometric_normal = select(-record.normal, record.normal, front);
    var shading_normal = geometric_normal;
    if (record_attributes.flags & HAS_NORMALS) != 0u {
        let unit = normalized((record_attributes.n0 * w + record_attributes.n1 * u) + record_attributes.n2 * v);
        let facing = select(-unit, unit, front);
        if dot_product(facing, direction) < 0.0f && dot_product(facing, geometric_normal) > 0.0f {
            shading_normal = facing;
        }
    }
    var albedo = material.albedo;
    if material.texture_offset != NONE && (record_attributes.flags & HAS_TEXCOORDS) != 0u {
        let s = (record_attributes.uv0.x * w + record_attributes.uv1.x * u) + record_attributes.uv2_u * v;
        let t = (record_attributes.uv0.y * w + record_attributes.uv1.y * u) + record_attributes.uv2_v * v;
        albedo *= sample_texture(material, s, t);
    }
    return Surface(
        position, record.offset, geometric_normal, shading_normal, albedo, record.material, record.light, front,
    );
}
