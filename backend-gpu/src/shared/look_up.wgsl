// What a lookup in layered hit buffers meets. Every kernel that includes this file binds the buffers here and has an
// LhbHeader in params.lhb.

// Longer lists are cut by halves before they are walked.
const WALKED_WHOLE: u32 = 16u;

const CLEARANCE: i32 = 65536;
const NO_ELEMENT: u32 = 0xffffffffu;

struct LhbElement {
    surface: u32,
    depth: u32,
}

struct LhbQuery {
    position: vec3<i32>,
    ray: u32,
    offset: vec2<i32>,
    leaves: u32,
    window: u32,
}

struct LatticePlane {
    // x and y of the normal in the halves of a word, x in the low one.
    normal_xy: u32,
    // z in the low half.
    normal_z: u32,
    offset: i32,
}

// How much there is: bindings may be longer than what they hold.
struct LhbHeader {
    size: u32,
    view_count: u32,
    element_count: u32,
    plane_count: u32,
}

@group(0) @binding(10) var<storage, read> views: array<View>;
@group(0) @binding(11) var<storage, read> offsets: array<u32>;
@group(0) @binding(12) var<storage, read> elements: array<LhbElement>;
@group(0) @binding(13) var<storage, read> planes: array<LatticePlane>;

// A list as a query reads it.
struct Place {
    begin: u32,
    end: u32,
    // The position's depth.
    z: i32,
    // 1 from the farthest element on.
    reversed: u32,
}

// The first element that lies ahead of a query.
fn look_up(query: LhbQuery) -> LhbElement {
    let nothing = LhbElement(NO_ELEMENT, 0u);
    if (query.ray >> 1u) >= params.lhb.view_count {
        return nothing;
    }
    let place = place_of(query);
    if place.begin > place.end || place.end > params.lhb.element_count {
        return nothing;
    }
    let window = i32(query.window);
    for (var rank = behind(place, window); rank < place.end - place.begin; rank++) {
        let element = elements[index_of(place, rank)];
        let distance = distance_to(place, element.depth);
        let surface = element.surface ^ place.reversed;
        if distance > window || (distance >= -window && is_entered(query, surface)) {
            return LhbElement(surface, element.depth);
        }
    }
    return nothing;
}

fn place_of(query: LhbQuery) -> Place {
    let number = query.ray >> 1u;
    let view = views[number];
    let size = params.lhb.size;
    let bits = subpixel_bits(size);
    let at = project(view, query.position, size);
    let edge = vec2<i32>(i32(size << bits) - 1);
    let pixel = vec2<u32>(clamp(at.xy + query.offset, vec2<i32>(0), edge)) >> vec2<u32>(bits);
    let list = (number * size + pixel.y) * size + pixel.x;
    return Place(offsets[list], offsets[list + 1u], at.z + i32(DEPTH_ORIGIN), query.ray & 1u);
}

// Where the element of a rank is: the rank counts in the order in which the query reads.
fn index_of(place: Place, rank: u32) -> u32 {
    return select(place.begin + rank, place.end - 1u - rank, place.reversed == 1u);
}

fn distance_to(place: Place, depth: u32) -> i32 {
    let ahead = i32(depth) - place.z;
    return select(ahead, -ahead, place.reversed == 1u);
}

// A rank below which all elements are behind the window. Walking a long list takes longer than some drivers let loops run.
fn behind(place: Place, window: i32) -> u32 {
    var low = 0u;
    var high = place.end - place.begin;
    while high - low > WALKED_WHOLE {
        let middle = low + (high - low) / 2u;
        if distance_to(place, elements[index_of(place, middle)].depth) < -window {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// Whether the query's position is before the plane of a surface, on the side that it shows, and that is the side that the
// query left its own surface on.
fn is_entered(query: LhbQuery, surface: u32) -> bool {
    let number = surface >> 1u;
    if ((surface ^ query.leaves) & 1u) != 0u || number == query.leaves >> 1u || number >= params.lhb.plane_count {
        return false;
    }
    let plane = planes[number];
    let normal = vec3<i32>(i32(plane.normal_xy << 16u), i32(plane.normal_xy), i32(plane.normal_z << 16u));
    let side = along(vec4<i32>(normal >> vec3<u32>(16u), 0), query.position) - plane.offset;
    if (surface & 1u) == 1u {
        return side > CLEARANCE;
    }
    return side < -CLEARANCE;
}
