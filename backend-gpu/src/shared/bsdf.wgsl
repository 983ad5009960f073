// Scattering at a surface, in the frame of the shading normal (z up). Twin of core/src/transport/bsdf.rs.

const INV_PI: f32 = 0.31830987f;

struct BsdfValue {
    f_cos: vec3<f32>,
    pdf: f32,
}

struct BsdfSample {
    direction: vec3<f32>,
    weight: vec3<f32>,
    pdf: f32,
}

// Schlick's reflectance at cosine c.
fn schlick(material: MaterialRecord, c: f32) -> vec3<f32> {
    let f0 = material.specular_f0;
    let clamped = select(1.0f, c, c < 1.0f);
    let m = 1.0f - clamped;
    let m2 = m * m;
    return f0 + (vec3<f32>(material.specular_f90) - f0) * (m2 * m2 * m);
}

fn average(c: vec3<f32>) -> f32 {
    return ((c.x + c.y) + c.z) * 0.33333334f;
}

// Probability of sampling the specular lobe for a viewer at cosine c.
fn specular_probability(material: MaterialRecord, albedo: vec3<f32>, c: f32) -> f32 {
    if material.specular_f90 == 0.0f {
        return 0.0f;
    }
    let f = average(schlick(material, c));
    let d = average(albedo) * (1.0f - f);
    let sum = f + d;
    if sum > 0.0f {
        return f / sum;
    }
    return 1.0f;
}

// GGX distribution of half vectors.
fn distribution(alpha: f32, h: vec3<f32>) -> f32 {
    let alpha_squared = alpha * alpha;
    let d = (h.x * h.x + h.y * h.y) + alpha_squared * (h.z * h.z);
    return alpha_squared * INV_PI / (d * d);
}

// Value and pdf of an opaque material; zeros below the horizon.
fn evaluate(material: MaterialRecord, albedo: vec3<f32>, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if !(wo.z > 0.0f && wi.z > 0.0f) {
        return BsdfValue(vec3<f32>(0.0f), 0.0f);
    }
    let cosine_pdf = wi.z * INV_PI;
    if material.specular_f90 == 0.0f {
        return BsdfValue(albedo * cosine_pdf, cosine_pdf);
    }
    let one = vec3<f32>(1.0f);
    let kept = (one - schlick(material, wo.z)) * (one - schlick(material, wi.z));
    let h = normalized(wo + wi);
    let d = distribution(material.alpha, h);
    let k = material.smith_k;
    let visibility = 1.0f / ((wo.z * (1.0f - k) + k) * (wi.z * (1.0f - k) + k));
    let specular = schlick(material, dot_product(wo, h)) * (d * visibility * 0.25f);
    let alpha_squared = material.alpha * material.alpha;
    let root = sqrt(alpha_squared + (1.0f - alpha_squared) * (wo.z * wo.z));
    let specular_pdf = d / (2.0f * (wo.z + root));
    let p = specular_probability(material, albedo, wo.z);
    return BsdfValue(
        albedo * kept * cosine_pdf + specular * wi.z,
        (1.0f - p) * cosine_pdf + p * specular_pdf,
    );
}

// A direction for an opaque material: `lobe` picks the lobe, (u, v) the direction.
fn sample_opaque(
    material: MaterialRecord,
    albedo: vec3<f32>,
    wo: vec3<f32>,
    lobe: f32,
    u: f32,
    v: f32,
) -> BsdfSample {
    if material.specular_f90 == 0.0f {
        let diffuse = cosine_hemisphere(u, v);
        if wo.z > 0.0f && diffuse.z > 0.0f {
            return BsdfSample(diffuse, albedo, diffuse.z * INV_PI);
        }
        return BsdfSample(vec3<f32>(0.0f), vec3<f32>(0.0f), 0.0f);
    }
    let specular = lobe < specular_probability(material, albedo, wo.z);
    var wi: vec3<f32>;
    if specular {
        wi = reflect_visible(material.alpha, wo, u, v);
    } else {
        wi = cosine_hemisphere(u, v);
    }
    let value = evaluate(material, albedo, wo, wi);
    if !(value.pdf > 0.0f) {
        return BsdfSample(vec3<f32>(0.0f), vec3<f32>(0.0f), 0.0f);
    }
    let inverse = 1.0f / value.pdf;
    return BsdfSample(wi, value.f_cos * inverse, value.pdf);
}

// Cosine-weighted direction (Malley).
fn cosine_hemisphere(u: f32, v: f32) -> vec3<f32> {
    let p = concentric_disc(u, v);
    let squared = 1.0f - (p.x * p.x + p.y * p.y);
    if squared > 0.0f {
        return vec3<f32>(p, sqrt(squared));
    }
    return vec3<f32>(p, 0.0f);
}

// The mirror image of wo about a visible GGX normal.
fn reflect_visible(alpha: f32, wo: vec3<f32>, u: f32, v: f32) -> vec3<f32> {
    let stretched = normalized(vec3<f32>(wo.x * alpha, wo.y * alpha, wo.z));
    let sc = sin_cos_turns(u);
    let z = (1.0f - v) * (1.0f + stretched.z) - stretched.z;
    let squared = 1.0f - z * z;
    var r = 0.0f;
    if squared > 0.0f {
        r = sqrt(squared);
    }
    let cap = vec3<f32>(r * sc.y, r * sc.x, z) + stretched;
    let h = normalized(vec3<f32>(cap.x * alpha, cap.y * alpha, cap.z));
    return h * (2.0f * dot_product(wo, h)) - wo;
}

// The perfect mirror.
fn sample_mirror(material: MaterialRecord, wo: vec3<f32>) -> BsdfSample {
    return BsdfSample(vec3<f32>(-wo.x, -wo.y, wo.z), material.specular_f0, 0.0f);
}

// A smooth dielectric seen from the front (outside) or back.
fn sample_dielectric(material: MaterialRecord, front: bool, wo: vec3<f32>, choice: f32) -> BsdfSample {
    var eta = material.ior;
    if front {
        eta = 1.0f / material.ior;
    }
    let sine_squared = eta * eta * (1.0f - wo.z * wo.z);
    var reflectance = 1.0f;
    var cosine = 0.0f;
    if sine_squared < 1.0f {
        cosine = sqrt(1.0f - sine_squared);
        let s = (eta * wo.z - cosine) / (eta * wo.z + cosine);
        let p = (wo.z - eta * cosine) / (wo.z + eta * cosine);
        reflectance = (s * s + p * p) * 0.5f;
    }
    if choice < reflectance {
        return BsdfSample(vec3<f32>(-wo.x, -wo.y, wo.z), vec3<f32>(1.0f), 0.0f);
    }
    let direction = normalized(vec3<f32>(-(wo.x * eta), -(wo.y * eta), -cosine));
    return BsdfSample(direction, vec3<f32>(eta * eta), 0.0f);
}
