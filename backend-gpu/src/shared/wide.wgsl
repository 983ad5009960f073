// 64-bit integers as two words, the low one first, in two's complement. They cost 4 to 17 times what 32 bits do: for
// what is done once per triangle.

// The product of two words.
fn wide_mul_unsigned(a: u32, b: u32) -> vec2<u32> {
    let a_low = a & 0xffffu;
    let a_high = a >> 16u;
    let b_low = b & 0xffffu;
    let b_high = b >> 16u;
    let low = a_low * b_low;
    // At most (2^16 - 1)^2 + 2^16 - 1 each: no carry is lost.
    let middle = a_high * b_low + (low >> 16u);
    let cross = a_low * b_high + (middle & 0xffffu);
    return vec2<u32>(a * b, a_high * b_high + (middle >> 16u) + (cross >> 16u));
}

// The product of two signed words.
fn wide_mul(a: i32, b: i32) -> vec2<u32> {
    let product = wide_mul_unsigned(u32(a), u32(b));
    // A negative word stands for itself plus 2^32.
    let excess = select(0u, u32(b), a < 0) + select(0u, u32(a), b < 0);
    return vec2<u32>(product.x, product.y - excess);
}

fn wide_add(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + select(0u, 1u, low < a.x));
}

fn wide_sub(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(a.x - b.x, a.y - b.y - select(0u, 1u, a.x < b.x));
}

// a * b modulo 2^64.
fn wide_scale(a: vec2<u32>, b: i32) -> vec2<u32> {
    let product = wide_mul_unsigned(a.x, u32(b));
    let excess = select(0u, a.x, b < 0);
    return vec2<u32>(product.x, product.y + a.y * u32(b) - excess);
}

// a * 2^bits modulo 2^64, for 0 < bits < 32.
fn wide_shift_left(a: vec2<u32>, bits: u32) -> vec2<u32> {
    return vec2<u32>(a.x << bits, (a.y << bits) | (a.x >> (32u - bits)));
}

// The low word of floor(a / divisor), for 0 < divisor < 2^31.
fn wide_div_floor(a: vec2<u32>, divisor: u32) -> u32 {
    // floor(a / d) = -1 - floor((-1 - a) / d), and -1 - x is ~x.
    let flip = select(0u, 0xffffffffu, (a.y >> 31u) != 0u);
    let magnitude = a ^ vec2<u32>(flip);
    return divide_words(magnitude.y % divisor, magnitude.x, divisor) ^ flip;
}

// floor((high * 2^32 + low) / divisor), for high < divisor: two digits of 16 bits after Knuth, The Art of Computer
// Programming 2, 4.3.1, algorithm D.
fn divide_words(high: u32, low: u32, divisor: u32) -> u32 {
    let shift = countLeadingZeros(divisor);
    let d = divisor << shift;
    // Two shifts, because a shift by 32 is none.
    let top = (high << shift) | ((low >> 1u) >> (31u - shift));
    let rest = low << shift;
    let first = digit_of_quotient(top, rest >> 16u, d);
    let left = (top << 16u) + (rest >> 16u) - first * d;
    return (first << 16u) | digit_of_quotient(left, rest & 0xffffu, d);
}

// floor((high * 2^16 + next) / d), for high < d, d >= 2^31 and next < 2^16.
fn digit_of_quotient(high: u32, next: u32, d: u32) -> u32 {
    let d_high = d >> 16u;
    let d_low = d & 0xffffu;
    var digit = high / d_high;
    var rest = high - digit * d_high;
    // The estimate is at most two too large.
    for (var i = 0u; i < 2u; i++) {
        if rest < 0x10000u && (digit >= 0x10000u || digit * d_low > ((rest << 16u) | next)) {
            digit -= 1u;
            rest += d_high;
        }
    }
    return digit;
}
