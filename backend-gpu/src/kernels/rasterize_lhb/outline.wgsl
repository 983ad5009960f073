// What one triangle covers of one view, and how deep it lies there.

struct Outline {
    // The vertices on the screen, in the order in which the area is positive.
    p0: vec2<i32>,
    p1: vec2<i32>,
    p2: vec2<i32>,
    // Where they are among the projected ones, which have z too: that is read only for depths.
    places: vec3<u32>,
    // Twice the area, A of the contract.
    area: i32,
    surface: u32,
    // The view's first list.
    list: u32,
    // The pixels whose centres are within the bounds: the first column and row, and how many. No columns where the
    // triangle covers nothing.
    first: vec2<i32>,
    size: vec2<u32>,
}

// The edge functions of 0->1, 1->2, 2->0, less 1 where a centre on the edge is not covered: covered is what is >= 0.
struct Edges {
    // At the first pixel of the bounds.
    origin: vec3<i32>,
    // From one column and from one row to the next.
    step_x: vec3<i32>,
    step_y: vec3<i32>,
}

// Depth before it is clamped, modulo 2^32.
struct Plane {
    origin: u32,
    step_x: u32,
    step_y: u32,
    low: i32,
    high: i32,
}

fn screen_position(place: u32) -> vec2<i32> {
    let word = projected[place].x;
    return vec2<i32>(vec2<u32>(word & 0xffffu, word >> 16u));
}

// `view` counts from the first of the dispatch.
fn setup(view: u32, triangle: u32) -> Outline {
    let corners = vec3<u32>(triangles[3u * triangle], triangles[3u * triangle + 1u], triangles[3u * triangle + 2u]);
    var places = vec3<u32>(view * params.vertex_count) + corners;
    let p0 = screen_position(places.x);
    var p1 = screen_position(places.y);
    var p2 = screen_position(places.z);
    var area = (p1.x - p0.x) * (p2.y - p0.y) - (p1.y - p0.y) * (p2.x - p0.x);
    let front = area < 0;
    if front {
        let other = p1;
        p1 = p2;
        p2 = other;
        places = places.xzy;
        area = -area;
    }
    let bits = subpixel_bits(params.call.size);
    let half = 1i << (bits - 1u);
    let first = (min(p0, min(p1, p2)) + vec2<i32>(half - 1)) >> vec2<u32>(bits);
    let last = (max(p0, max(p1, p2)) - vec2<i32>(half)) >> vec2<u32>(bits);
    var extent = vec2<u32>();
    if area != 0 && all(first <= last) {
        extent = vec2<u32>(last - first) + vec2<u32>(1u);
    }
    let surface = 2u * triangle + select(0u, 1u, front);
    let list = (params.view_begin + view) * params.call.size * params.call.size;
    return Outline(p0, p1, p2, places, area, surface, list, first, extent);
}

// The centre of the first pixel of the bounds.
fn first_centre(outline: Outline) -> vec2<i32> {
    let bits = subpixel_bits(params.call.size);
    return outline.first * (1i << bits) + vec2<i32>(1i << (bits - 1u));
}

fn edges_of(outline: Outline) -> Edges {
    let x = vec3<i32>(outline.p0.x, outline.p1.x, outline.p2.x);
    let y = vec3<i32>(outline.p0.y, outline.p1.y, outline.p2.y);
    let dx = x.yzx - x;
    let dy = y.yzx - y;
    let centre = first_centre(outline);
    let at = dx * (vec3<i32>(centre.y) - y) - dy * (vec3<i32>(centre.x) - x);
    let zero = vec3<i32>();
    let top_left = (dy < zero) | ((dy == zero) & (dx > zero));
    let pixel = 1i << subpixel_bits(params.call.size);
    return Edges(at - select(vec3<i32>(1), zero, top_left), -dy * pixel, dx * pixel);
}

// The edge functions at a pixel of the bounds, counted from the first.
fn edges_at(edges: Edges, column: u32, row: u32) -> vec3<i32> {
    return edges.origin + edges.step_x * i32(column) + edges.step_y * i32(row);
}

fn covers(at: vec3<i32>) -> bool {
    return all(at >= vec3<i32>());
}

fn plane_of(outline: Outline) -> Plane {
    let a = outline.p1 - outline.p0;
    let b = outline.p2 - outline.p0;
    let z = vec3<i32>(
        i32(projected[outline.places.x].y),
        i32(projected[outline.places.y].y),
        i32(projected[outline.places.z].y),
    );
    let normal_x = wide_sub(wide_mul(z.y - z.x, b.y), wide_mul(z.z - z.x, a.y));
    let normal_y = wide_sub(wide_mul(z.z - z.x, a.x), wide_mul(z.y - z.x, b.x));
    let reach = first_centre(outline) - outline.p0;
    let there = wide_add(wide_scale(normal_x, reach.x), wide_scale(normal_y, reach.y));
    let bits = subpixel_bits(params.call.size);
    let area = u32(outline.area);
    return Plane(
        u32(z.x) + divide_rounded(there, area),
        divide_rounded(wide_shift_left(normal_x, bits), area),
        divide_rounded(wide_shift_left(normal_y, bits), area),
        min(z.x, min(z.y, z.z)),
        max(z.x, max(z.y, z.z)),
    );
}

// r of the contract.
fn divide_rounded(n: vec2<u32>, area: u32) -> u32 {
    return wide_div_floor(wide_add(n, vec2<u32>(area / 2u, 0u)), area);
}

fn depth_at(plane: Plane, column: u32, row: u32) -> u32 {
    let z = i32(plane.origin + column * plane.step_x + row * plane.step_y);
    return u32(clamp(z, plane.low, plane.high)) + DEPTH_ORIGIN;
}
