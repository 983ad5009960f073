// Ray origins off the surface they start on. Twin of core/src/transport/offset.rs.

// A point at `leaving_distance` from `position`, on the side of the surface that `direction` leaves to.
fn offset_origin(
    position: vec3<f32>,
    leaving_distance: f32,
    normal: vec3<f32>,
    direction: vec3<f32>,
) -> vec3<f32> {
    let side = select(leaving_distance, -leaving_distance, dot_product(direction, normal) < 0.0f);
    return position + normal * side;
}
