// Closest hits of Embree for the rays that `cargo bench --bench lhb -- --dump FILE` wrote: millions per second on all cores, one ray a
// call; median, least and most over the rounds, for the rays in the order of the file and in a random one.
//
//     c++ -O3 -march=native benchmarks/embree_rays.cpp -lembree3 -lpthread -o target/embree_rays    (or -lembree4)
//     target/embree_rays FILE [ROUNDS]

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

struct Ray {
    float origin[3], t_min, direction[3], t_max;
};

struct Input {
    std::vector<float> corners;
    std::vector<Ray> rays;
};

static Input read(const char* path) {
    std::FILE* file = std::fopen(path, "rb");
    if (!file) {
        std::perror(path);
        std::exit(1);
    }
    std::uint64_t counts[2];
    Input input;
    bool whole = std::fread(counts, sizeof counts, 1, file) == 1;
    if (whole) {
        input.corners.resize(9 * counts[0]);
        input.rays.resize(counts[1]);
        whole = std::fread(input.corners.data(), 36, counts[0], file) == counts[0]
            && std::fread(input.rays.data(), sizeof(Ray), counts[1], file) == counts[1];
    }
    std::fclose(file);
    if (!whole) {
        std::fprintf(stderr, "%s: ends early\n", path);
        std::exit(1);
    }
    return input;
}

static RTCScene build(RTCDevice device, const std::vector<float>& corners) {
    const std::size_t triangles = corners.size() / 9;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * triangles);
    std::memcpy(vertices, corners.data(), corners.size() * sizeof(float));
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles));
    for (std::size_t i = 0; i < 3 * triangles; i++) {
        indices[i] = static_cast<unsigned>(i);
    }
    rtcCommitGeometry(geometry);
    RTCScene scene = rtcNewScene(device);
    rtcAttachGeometry(scene, geometry);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene);
    return scene;
}

static bool meets(RTCScene scene, const Ray& ray) {
    RTCRayHit query = {};
    query.ray.org_x = ray.origin[0];
    query.ray.org_y = ray.origin[1];
    query.ray.org_z = ray.origin[2];
    query.ray.dir_x = ray.direction[0];
    query.ray.dir_y = ray.direction[1];
    query.ray.dir_z = ray.direction[2];
    query.ray.tnear = ray.t_min;
    query.ray.tfar = ray.t_max;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
#endif
    return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

// Rays per second of the wall's time, a contiguous part of them for each thread.
static double round(RTCScene scene, const std::vector<Ray>& rays, unsigned threads) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::size_t> met(threads);
    std::vector<std::thread> pool;
    for (unsigned t = 0; t < threads; t++) {
        pool.emplace_back([&, t] {
            std::size_t count = 0;
            for (std::size_t i = rays.size() * t / threads; i < rays.size() * (t + 1) / threads; i++) {
                count += meets(scene, rays[i]);
            }
            met[t] = count;
        });
    }
    for (auto& thread : pool) {
        thread.join();
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    return rays.size() / elapsed.count();
}

static void report(const char* order, RTCScene scene, const std::vector<Ray>& rays, unsigned rounds) {
    const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    std::vector<double> rates;
    for (unsigned i = 0; i <= rounds; i++) {
        const double rate = round(scene, rays, threads);
        if (i > 0) {
            rates.push_back(rate / 1e6);
        }
    }
    std::sort(rates.begin(), rates.end());
    std::printf("%s %.2f %.2f %.2f\n", order, rates[rates.size() / 2], rates.front(), rates.back());
}

int main(int count, char** arguments) {
    if (count < 2) {
        std::fprintf(stderr, "usage: embree_rays FILE [ROUNDS]\n");
        return 2;
    }
    const unsigned rounds = count > 2 ? std::max(1, std::atoi(arguments[2])) : 3;
    Input input = read(arguments[1]);
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = build(device, input.corners);
    report("sorted", scene, input.rays, rounds);
    std::shuffle(input.rays.begin(), input.rays.end(), std::mt19937(1));
    report("shuffled", scene, input.rays, rounds);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
}
