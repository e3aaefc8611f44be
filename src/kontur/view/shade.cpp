// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/shade.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kontur/base/checks.h"
#include "kontur/base/parallel.h"
#include "kontur/view/depth_buffer.h"

namespace kontur {
namespace {

constexpr int kChunkRows = 16;

double linear_from_srgb(double s) { return std::pow(s, 2.2); }
double srgb_from_linear(double l) { return std::pow(std::clamp(l, 0.0, 1.0), 1 / 2.2); }

Vec3 as_vec3(const std::array<float, 3>& n) { return {n[0], n[1], n[2]}; }

/// The samples of one pixel reduced to the nearest one.
DepthBuffer nearest_per_pixel(const DepthBuffer& fine, int samples) {
    DepthBuffer coarse{fine.width / samples, fine.height / samples, {}};
    coarse.pixels.resize(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height));
    for (int y = 0; y < fine.height; ++y)
        for (int x = 0; x < fine.width; ++x) {
            auto& nearest = coarse.pixels[static_cast<std::size_t>(y / samples) * static_cast<std::size_t>(coarse.width) +
                                          static_cast<std::size_t>(x / samples)];
            if (fine.at(x, y).depth_mm > nearest.depth_mm) nearest = fine.at(x, y);
        }
    return coarse;
}

/// Screen-space ambient occlusion: how much of the light from all around the relief within some radius keeps out.
class Occlusion {
public:
    Occlusion(const DepthBuffer& buffer, double pixel_mm, const Work& work)
        : buffer_(buffer), pixel_mm_(pixel_mm), radius_(0.09 * std::min(buffer.width, buffer.height)) {
        const auto count = buffer.pixels.size();
        raw_.resize(count);
        smooth_.resize(count);
        for_rows(work, [this](int y) {
            for (int x = 0; x < buffer_.width; ++x) raw_[index(x, y)] = raw(x, y);
        });
        for_rows(work, [this](int y) {
            for (int x = 0; x < buffer_.width; ++x) smooth_[index(x, y)] = smoothed(x, y);
        });
    }

    /// 0: open to all sides; 1: shut in.
    double at(int x, int y) const { return smooth_[index(x, y)]; }

private:
    template <class Body>
    void for_rows(const Work& work, const Body& body) const {
        parallel_for(buffer_.height, kChunkRows, work, [&](std::int64_t begin, std::int64_t end) {
            for (auto y = static_cast<int>(begin); y < end; ++y) body(y);
        });
    }

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(buffer_.width) + static_cast<std::size_t>(x);
    }
    bool is_covered(int x, int y) const {
        return x >= 0 && y >= 0 && x < buffer_.width && y < buffer_.height && buffer_.at(x, y).is_covered();
    }

    /// Samples on a spiral, turned from pixel to pixel in a 4 x 4 pattern that `smoothed` averages out again.
    float raw(int x, int y) const {
        if (!is_covered(x, y)) return 0;
        constexpr int kSamples = 32;
        constexpr double kGoldenAngle = 2.399963229728653;
        const auto& here = buffer_.at(x, y);
        const Vec3 normal = as_vec3(here.normal);
        const double turn = ((x % 4) * 4 + (y % 4) * 7 % 16) * (2 * std::numbers::pi / 16);
        double sum = 0;
        for (int s = 0; s < kSamples; ++s) {
            const double r = radius_ * (s + 0.5) / kSamples, angle = s * kGoldenAngle + turn;
            const int sx = x + static_cast<int>(std::lround(r * std::cos(angle)));
            const int sy = y + static_cast<int>(std::lround(r * std::sin(angle)));
            if (!is_covered(sx, sy)) continue;
            const Vec3 d{static_cast<double>(sx - x), static_cast<double>(y - sy),
                         (buffer_.at(sx, sy).depth_mm - here.depth_mm) / pixel_mm_};
            const double length = norm(d), reach = length / (1.5 * radius_);
            if (length > 0) sum += std::max(0.0, dot(normal, d) / length - 0.05) / (1 + reach * reach);
        }
        return static_cast<float>(sum / kSamples);
    }

    /// Mean over the 4 x 4 pattern and its neighbours, leaving out pixels of another depth.
    float smoothed(int x, int y) const {
        if (!is_covered(x, y)) return 0;
        const float depth = buffer_.at(x, y).depth_mm;
        const auto near = static_cast<float>(0.25 * radius_ * pixel_mm_);
        float sum = 0, count = 0;
        for (int sy = y - 4; sy < y + 4; ++sy)
            for (int sx = x - 4; sx < x + 4; ++sx)
                if (is_covered(sx, sy) && std::abs(buffer_.at(sx, sy).depth_mm - depth) < near) {
                    sum += raw_[index(sx, sy)];
                    ++count;
                }
        return count > 0 ? sum / count : 0;
    }

    const DepthBuffer& buffer_;
    double pixel_mm_, radius_;
    std::vector<float> raw_, smooth_;
};

/// Light that a surface element sends to the viewer, linear RGB.
Vec3 lit(const Vec3& material, const Vec3& normal, double occlusion) {
    static const Vec3 key = normalized({-0.45, 0.62, 0.64}), fill = normalized({0.75, 0.05, 0.55});
    static const Vec3 halfway = normalized(key + Vec3{0, 0, 1});
    const double open = std::max(0.0, 1 - 2.6 * occlusion);
    const double ambient = (0.22 + 0.10 * normal.y) * open;
    const double direct = 0.92 * std::max(0.0, dot(normal, key)) * (0.4 + 0.6 * open);
    const double from_right = 0.14 * std::max(0.0, dot(normal, fill)) * open;
    const double gloss = 0.10 * std::pow(std::max(0.0, dot(normal, halfway)), 38) * open;
    const double rim = 0.10 * std::pow(1 - std::clamp(normal.z, 0.0, 1.0), 3) * (0.5 + 0.5 * normal.y) * open;
    return (ambient + direct + from_right) * material + Vec3{1, 1, 1} * (gloss + rim);
}

std::uint32_t premultiplied_argb(const Vec3& linear, double alpha) {
    const auto channel = [&](double l) {
        return static_cast<std::uint32_t>(std::lround(255 * alpha * srgb_from_linear(l)));
    };
    return static_cast<std::uint32_t>(std::lround(255 * alpha)) << 24 | channel(linear.x) << 16 | channel(linear.y) << 8 |
           channel(linear.z);
}

}  // namespace

ShadedSurface shade(const TriangleMesh& mesh, const Camera& camera, const ShadeOptions& options, const Work& work) {
    check_mesh(mesh);
    check_at_least("the width of the view in pixels", camera.width, 1);
    check_at_least("the height of the view in pixels", camera.height, 1);
    check_above_0("the pixel size of the view", camera.pixel_mm, " mm");
    check_at_least("the number of samples per pixel", options.samples, 1);
    check_from_0_to_1("the red of the material", options.color.x);
    check_from_0_to_1("the green of the material", options.color.y);
    check_from_0_to_1("the blue of the material", options.color.z);
    check_threads(work.threads);
    const int samples = options.samples;
    const Camera fine_camera{camera.plane, camera.width * samples, camera.height * samples, camera.pixel_mm / samples};
    const DepthBuffer fine = render_depth(mesh, fine_camera, work);
    const DepthBuffer coarse = nearest_per_pixel(fine, samples);
    const Occlusion occlusion(coarse, camera.pixel_mm, work);
    const Vec3 material{linear_from_srgb(options.color.x), linear_from_srgb(options.color.y),
                        linear_from_srgb(options.color.z)};

    ShadedSurface result{camera.width, camera.height, {}, {}};
    result.argb.resize(coarse.pixels.size());
    result.depth_mm.resize(coarse.pixels.size());
    const auto shade_pixel = [&](int x, int y) {
        Vec3 sum;
        int covered = 0;
        for (int sy = y * samples; sy < (y + 1) * samples; ++sy)
            for (int sx = x * samples; sx < (x + 1) * samples; ++sx)
                if (const auto& sample = fine.at(sx, sy); sample.is_covered()) {
                    sum += lit(material, as_vec3(sample.normal), occlusion.at(x, y));
                    ++covered;
                }
        return covered == 0 ? 0 : premultiplied_argb(sum / covered, static_cast<double>(covered) / (samples * samples));
    };
    parallel_for(camera.height, kChunkRows, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < camera.width; ++x) {
                const std::size_t i =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x);
                result.argb[i] = shade_pixel(x, y);
                result.depth_mm[i] = coarse.pixels[i].depth_mm;
            }
    });
    return result;
}

}  // namespace kontur
