// Angles in turns, by polynomials of our own. Twin of core/src/math/trig.rs.

const FRAC_PI_2: f32 = 1.5707963267948966f;
const FRAC_PI_4: f32 = 0.7853981633974483f;

// (sin, cos) of `a` radians, -pi/4 <= a <= pi/4.
fn sin_cos_octant(a: f32) -> vec2<f32> {
    let z = a * a;
    let sine = ((-1.9515296e-4f * z + 8.332161e-3f) * z - 1.6666655e-1f) * z * a + a;
    let cosine =
        ((2.4433157e-5f * z - 1.3887316e-3f) * z + 4.1666646e-2f) * (z * z) - 0.5f * z + 1.0f;
    return vec2<f32>(sine, cosine);
}

// (sin, cos) of full turns, 0 <= turns <= 1.
fn sin_cos_turns(turns: f32) -> vec2<f32> {
    let quarters = turns * 4.0f;
    let quadrant = i32(quarters + 0.5f);
    let sc = sin_cos_octant((quarters - f32(quadrant)) * FRAC_PI_2);
    let swap = (quadrant & 1) == 1;
    let s = select(sc.x, sc.y, swap);
    let c = select(sc.y, sc.x, swap);
    return vec2<f32>(select(s, -s, (quadrant & 2) == 2), select(c, -c, ((quadrant + 1) & 2) == 2));
}

// The angle of (x, y) in turns, in [0, 1); 0 at the origin.
fn atan2_turns(y: f32, x: f32) -> f32 {
    let ax = abs(x);
    let ay = abs(y);
    let larger_side = select(ay, ax, ax > ay);
    let smaller_side = select(ax, ay, ax > ay);
    if !(larger_side > 0.0f) {
        return 0.0f;
    }
    let ratio = smaller_side / larger_side;
    let shifted = ratio > 0.41421357f;
    let t = select(ratio, (ratio - 1.0f) / (ratio + 1.0f), shifted);
    let z = t * t;
    let p = (((8.0537445e-2f * z - 1.3877686e-1f) * z + 1.9977711e-1f) * z - 3.333295e-1f) * z * t + t;
    let first = select(p, p + FRAC_PI_4, shifted) * 0.15915494f;
    let octant = select(first, 0.25f - first, ay > ax);
    let halved = select(octant, 0.5f - octant, x < 0.0f);
    let full = select(halved, 1.0f - halved, y < 0.0f);
    return select(0.0f, full, full < 1.0f);
}
