// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/canvas.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <string>

#include "kontur/base/error.h"

namespace kontur {
namespace {

template <auto Destroy>
struct Destroyer {
    template <class T>
    void operator()(T* object) const {
        Destroy(object);
    }
};
using SurfacePointer = std::unique_ptr<cairo_surface_t, Destroyer<cairo_surface_destroy>>;
using ContextPointer = std::unique_ptr<cairo_t, Destroyer<cairo_destroy>>;
using FontPointer = std::unique_ptr<cairo_scaled_font_t, Destroyer<cairo_scaled_font_destroy>>;
using FacePointer = std::unique_ptr<cairo_font_face_t, Destroyer<cairo_font_face_destroy>>;
using OptionsPointer = std::unique_ptr<cairo_font_options_t, Destroyer<cairo_font_options_destroy>>;
using PatternPointer = std::unique_ptr<cairo_pattern_t, Destroyer<cairo_pattern_destroy>>;

/// A font whose glyphs do not depend on the machine's screen settings; null where there is no font.
FontPointer make_font(bool bold) {
    // Where a font cannot be made, cairo 1.16 takes two locks in either order: two threads could wait for each other.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    const FacePointer face(cairo_toy_font_face_create("DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                                                      bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL));
    const OptionsPointer options(cairo_font_options_create());
    cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    cairo_matrix_t one;
    cairo_matrix_init_identity(&one);
    FontPointer font(cairo_scaled_font_create(face.get(), &one, &one, options.get()));
    cairo_text_extents_t extents;
    cairo_scaled_font_text_extents(font.get(), "x", &extents);
    if (cairo_scaled_font_status(font.get()) != CAIRO_STATUS_SUCCESS) font.reset();
    return font;
}

}  // namespace

struct Canvas::State {
    SurfacePointer surface;
    ContextPointer context;
    FontPointer regular, bold;

    cairo_t* cr() const { return context.get(); }

    void set_color(const Color& c) const { cairo_set_source_rgba(cr(), c.red, c.green, c.blue, c.alpha); }

    void add_path(std::span<const Point2> line, bool closed) const {
        for (std::size_t i = 0; i < line.size(); ++i)
            if (i == 0) cairo_move_to(cr(), line[i].x, line[i].y);
            else cairo_line_to(cr(), line[i].x, line[i].y);
        if (closed) cairo_close_path(cr());
    }

    /// Width of a text at size 1, without touching the context: a font that fails must not stop the drawing.
    double unit_width(std::string_view text, bool is_bold) const {
        const auto& font = is_bold ? bold : regular;
        if (!font) return 0;
        cairo_text_extents_t extents;
        cairo_scaled_font_text_extents(font.get(), std::string(text).c_str(), &extents);
        return extents.x_advance;
    }

    /// Adds the text's outline at (0, 0) of a context already moved and scaled to size 1.
    bool add_text_path(std::string_view text, bool is_bold) const {
        const auto& font = is_bold ? bold : regular;
        if (!font) return false;
        cairo_glyph_t* glyphs = nullptr;
        int count = 0;
        const auto status = cairo_scaled_font_text_to_glyphs(font.get(), 0, 0, text.data(), static_cast<int>(text.size()),
                                                             &glyphs, &count, nullptr, nullptr, nullptr);
        if (status != CAIRO_STATUS_SUCCESS) return false;
        cairo_set_font_face(cr(), cairo_scaled_font_get_font_face(font.get()));
        cairo_set_font_size(cr(), 1);
        cairo_glyph_path(cr(), glyphs, count);
        cairo_glyph_free(glyphs);
        return true;
    }
};

Canvas::Canvas(int width, int height) : state_(std::make_unique<State>()) {
    state_->surface.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
    state_->context.reset(cairo_create(state_->surface.get()));
    if (cairo_status(state_->cr()) != CAIRO_STATUS_SUCCESS)
        throw Error(ErrorKind::too_large, "a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                                              " pixels cannot be made; at most 32767 on a side are possible");
    state_->regular = make_font(false);
    state_->bold = make_font(true);
    cairo_set_line_join(state_->cr(), CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(state_->cr(), CAIRO_LINE_CAP_ROUND);
}

Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;

void Canvas::fill(const Rect& rect, const Color& color, double corner_radius) {
    cairo_t* cr = state_->cr();
    state_->set_color(color);
    if (corner_radius <= 0) {
        cairo_rectangle(cr, rect.x, rect.y, rect.width, rect.height);
    } else {
        constexpr double kQuarter = std::numbers::pi / 2;
        const Rect inner = rect.inset(corner_radius);
        cairo_new_sub_path(cr);
        cairo_arc(cr, inner.right(), inner.y, corner_radius, -kQuarter, 0);
        cairo_arc(cr, inner.right(), inner.bottom(), corner_radius, 0, kQuarter);
        cairo_arc(cr, inner.x, inner.bottom(), corner_radius, kQuarter, 2 * kQuarter);
        cairo_arc(cr, inner.x, inner.y, corner_radius, 2 * kQuarter, 3 * kQuarter);
        cairo_close_path(cr);
    }
    cairo_fill(cr);
}

void Canvas::fill_gradient(const Rect& rect, const Color& top, const Color& bottom) {
    const PatternPointer pattern(cairo_pattern_create_linear(0, rect.y, 0, rect.bottom()));
    cairo_pattern_add_color_stop_rgb(pattern.get(), 0, top.red, top.green, top.blue);
    cairo_pattern_add_color_stop_rgb(pattern.get(), 1, bottom.red, bottom.green, bottom.blue);
    cairo_set_source(state_->cr(), pattern.get());
    cairo_rectangle(state_->cr(), rect.x, rect.y, rect.width, rect.height);
    cairo_fill(state_->cr());
}

void Canvas::frame(const Rect& rect, const Color& color, double line_width) {
    state_->set_color(color);
    cairo_set_line_width(state_->cr(), line_width);
    const Rect middle = rect.inset(0.5 * line_width);
    cairo_rectangle(state_->cr(), middle.x, middle.y, middle.width, middle.height);
    cairo_stroke(state_->cr());
}

void Canvas::stroke(std::span<const Point2> line, bool closed, const Color& color, double line_width) {
    state_->set_color(color);
    cairo_set_line_width(state_->cr(), line_width);
    state_->add_path(line, closed);
    cairo_stroke(state_->cr());
}

void Canvas::fill_polygons(std::span<const std::vector<Point2>> polygons, const Color& color) {
    state_->set_color(color);
    for (const auto& polygon : polygons) state_->add_path(polygon, true);
    cairo_set_fill_rule(state_->cr(), CAIRO_FILL_RULE_EVEN_ODD);
    cairo_fill(state_->cr());
}

void Canvas::dot(const Point2& at, double radius, const Color& color) {
    state_->set_color(color);
    cairo_new_sub_path(state_->cr());
    cairo_arc(state_->cr(), at.x, at.y, radius, 0, 2 * std::numbers::pi);
    cairo_fill(state_->cr());
}

void Canvas::blend(int x, int y, int width, int height, std::span<const std::uint32_t> argb) {
    const SurfacePointer source(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height));
    if (cairo_surface_status(source.get()) != CAIRO_STATUS_SUCCESS)
        throw Error(ErrorKind::too_large,
                    "no memory for a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
    unsigned char* data = cairo_image_surface_get_data(source.get());
    const int stride = cairo_image_surface_get_stride(source.get());
    for (int row = 0; row < height; ++row)
        std::copy_n(argb.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(width), width,
                    reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride));
    cairo_surface_mark_dirty(source.get());
    cairo_set_source_surface(state_->cr(), source.get(), x, y);
    cairo_pattern_set_filter(cairo_get_source(state_->cr()), CAIRO_FILTER_NEAREST);
    cairo_rectangle(state_->cr(), x, y, width, height);
    cairo_fill(state_->cr());
}

double Canvas::text(const Point2& at, std::string_view text, const TextStyle& style) {
    cairo_t* cr = state_->cr();
    const double width = text_width(text, style);
    const double shift = style.align == Align::left ? 0 : style.align == Align::center ? 0.5 * width : width;
    cairo_save(cr);
    cairo_translate(cr, at.x - shift, at.y);
    cairo_scale(cr, style.size_px, style.size_px);
    if (state_->add_text_path(text, style.bold)) {
        if (style.halo) {
            state_->set_color({0, 0, 0, 0.75 * style.color.alpha});
            cairo_set_line_width(cr, 0.22);
            cairo_stroke_preserve(cr);
        }
        state_->set_color(style.color);
        cairo_set_fill_rule(cr, CAIRO_FILL_RULE_WINDING);
        cairo_fill(cr);
    }
    cairo_restore(cr);
    return width;
}

double Canvas::text_width(std::string_view text, const TextStyle& style) const {
    return style.size_px * state_->unit_width(text, style.bold);
}

void Canvas::painted_text(const Point2& middle, const Point2& right, const Point2& down, std::string_view text,
                          const Color& color) {
    cairo_t* cr = state_->cr();
    // A capital letter is about 0.73 of the font size high and stands on the baseline.
    constexpr double kCapHeight = 0.73;
    cairo_save(cr);
    cairo_matrix_t matrix;
    cairo_matrix_init(&matrix, right.x, right.y, down.x, down.y, middle.x, middle.y);
    cairo_transform(cr, &matrix);
    cairo_translate(cr, -0.5 * state_->unit_width(text, true), 0.5 * kCapHeight);
    if (state_->add_text_path(text, true)) {
        state_->set_color(color);
        cairo_set_fill_rule(cr, CAIRO_FILL_RULE_WINDING);
        cairo_fill(cr);
    }
    cairo_restore(cr);
}

Canvas::ClipGuard Canvas::clip(const Rect& rect) {
    cairo_save(state_->cr());
    cairo_rectangle(state_->cr(), rect.x, rect.y, rect.width, rect.height);
    cairo_clip(state_->cr());
    return ClipGuard(*state_);
}

Canvas::ClipGuard::~ClipGuard() { cairo_restore(state_->cr()); }

RgbImage Canvas::image() const {
    cairo_surface_t* surface = state_->surface.get();
    cairo_surface_flush(surface);
    RgbImage result{cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface), {}};
    const unsigned char* data = cairo_image_surface_get_data(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    result.bytes.reserve(3 * static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height));
    for (int y = 0; y < result.height; ++y) {
        const auto* row = reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
        for (int x = 0; x < result.width; ++x)
            for (const int shift : {16, 8, 0}) result.bytes.push_back(static_cast<std::uint8_t>(row[x] >> shift));
    }
    return result;
}

}  // namespace kontur
