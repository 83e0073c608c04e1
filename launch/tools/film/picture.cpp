// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/picture.h"

#include <cairo.h>
#include <fmt/core.h>

#include <array>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::launch {
namespace {

struct Colour {
  double red, green, blue;
};
constexpr Colour kPaper{0.09, 0.10, 0.12}, kInk{0.95, 0.95, 0.96}, kPaleInk{0.62, 0.65, 0.70},
    kGood{0.16, 0.62, 0.35};
constexpr double kTitleSize = 22, kTextSize = 15, kValueSize = 21, kLabelSize = 14;
constexpr char kFont[] = "DejaVu Sans";
// Columns of the status line: episode, step, reward, return, success.
constexpr int kStatusColumns = 5;

using RedGreenBlue = std::array<uint8_t, 3>;

// Number of pictures of the policy's input: each camera's newest, then each camera's goal.
int PicturesOf(const ObservationSpec& spec) {
  return int(spec.cameras.size()) * (spec.goal_picture ? 2 : 1);
}

}  // namespace

struct FilmPicture::Canvas {
  Canvas(int width, int height)
      : surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
        context(cairo_create(surface)) {}
  ~Canvas() {
    cairo_destroy(context);
    cairo_surface_destroy(surface);
  }
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void Use(Colour colour) { cairo_set_source_rgb(context, colour.red, colour.green, colour.blue); }
  void UseFont(double size, bool bold = false) {
    cairo_select_font_face(context, kFont, CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context, size);
  }
  double WidthOf(const std::string& text) {
    cairo_text_extents_t extents;
    cairo_text_extents(context, text.c_str(), &extents);
    return extents.x_advance;
  }
  // The text, shortened to `width` with dots at its end if it is too long.
  std::string Fitted(std::string text, double width) {
    if (WidthOf(text) <= width) return text;
    while (!text.empty() && WidthOf(text + "…") > width) {
      while ((text.back() & 0xC0) == 0x80) text.pop_back();  // the rest of a UTF-8 character
      text.pop_back();
    }
    return text.empty() ? "" : text + "…";
  }
  // Returns the x position of the text's end.
  double Write(double x, double baseline, const std::string& text, double width) {
    const std::string fitted = Fitted(text, width);
    cairo_move_to(context, x, baseline);
    cairo_show_text(context, fitted.c_str());
    return x + WidthOf(fitted);
  }

  cairo_surface_t* surface;
  cairo_t* context;
};

FilmPicture::FilmPicture(const ObservationSpec& spec)
    : spec_(spec),
      layout_(MakeFilmLayout(PicturesOf(spec), spec.height, spec.width)),
      canvas_(std::make_unique<Canvas>(layout_.width, layout_.height)) {
  if (const auto status = cairo_status(canvas_->context); status != CAIRO_STATUS_SUCCESS) {
    throw RuntimeError("a picture of {} x {} pixels: {}", layout_.width, layout_.height,
                       cairo_status_to_string(status));
  }
  canvas_->UseFont(kTextSize);
  if (canvas_->WidthOf("m") <= 0) {
    throw RuntimeError("no font to write with: apt install fonts-dejavu-core");
  }
}

FilmPicture::~FilmPicture() = default;

std::span<const uint8_t> FilmPicture::pixels() const {
  return {cairo_image_surface_get_data(canvas_->surface),
          size_t(stride()) * size_t(layout_.height)};
}

int FilmPicture::stride() const { return cairo_image_surface_get_stride(canvas_->surface); }

template <class ColourAt>
void FilmPicture::Fill(const Box& box, const ColourAt& colour_at) {
  uint8_t* const pixels = cairo_image_surface_get_data(canvas_->surface);
  for (int row = 0; row < box.height; ++row) {
    uint8_t* pixel = pixels + size_t(box.y + row) * size_t(stride()) + 4 * size_t(box.x);
    for (int column = 0; column < box.width; ++column, pixel += 4) {
      const RedGreenBlue colour = colour_at(row, column);
      pixel[0] = colour[2];
      pixel[1] = colour[1];
      pixel[2] = colour[0];
    }
  }
}

void FilmPicture::DrawCamera(const Box& box, size_t camera, std::span<const uint8_t> frame) {
  const size_t plane = size_t(spec_.height) * size_t(spec_.width);
  const size_t channels = size_t(spec_.channels) / spec_.cameras.size();  // 3, or 1: grey
  const std::span<const uint8_t> picture =
      frame.subspan(camera * channels * plane, channels * plane);
  Fill(box, [&](int row, int column) -> RedGreenBlue {
    // Nearest neighbour, so that each pixel of the policy's input stays visible.
    const size_t at = size_t(row * spec_.height / box.height) * size_t(spec_.width) +
                      size_t(column * spec_.width / box.width);
    if (channels == 1) return {picture[at], picture[at], picture[at]};
    return {picture[at], picture[plane + at], picture[2 * plane + at]};
  });
}

void FilmPicture::DrawView(std::span<const uint8_t> view) {
  Fill(layout_.view, [&](int row, int column) -> RedGreenBlue {
    const size_t at = 3 * (size_t(row) * kFilmView + size_t(column));
    return {view[at], view[at + 1], view[at + 2]};
  });
}

void FilmPicture::DrawWords(const FilmText& text) {
  Canvas& canvas = *canvas_;
  canvas.Use(kInk);
  canvas.UseFont(kTitleSize, /*bold=*/true);
  const Box& title = layout_.title;
  const double end = canvas.Write(title.x, title.y + 37, text.title, title.width);
  canvas.Use(kPaleInk);
  canvas.UseFont(kTextSize);
  canvas.Write(end + 16, title.y + 37, text.subtitle, title.x + title.width - end - 16);

  canvas.UseFont(kLabelSize);
  const auto caption = [&](const Box& box, const std::string& words) {
    canvas.Write(box.x, box.y - 8, words, box.width);
  };
  for (size_t i = 0; i < layout_.cameras.size(); ++i) {
    const bool goal = i >= spec_.cameras.size();
    caption(layout_.cameras[i],
            fmt::format("{}, {} {}×{}", spec_.cameras[i % spec_.cameras.size()],
                        goal ? "goal picture" : "policy input", spec_.width, spec_.height));
  }
  caption(layout_.view,
          layout_.cameras.empty() ? "the policy sees numbers, no pictures" : "larger view");

  const Box& status = layout_.status;
  const int column = status.width / kStatusColumns;
  const std::array<std::pair<const char*, std::string>, kStatusColumns - 1> figures = {{
      {"episode", fmt::format("{} of {}", text.episode, text.episodes)},
      {"step", fmt::format("{}", text.step)},
      {"reward", text.reward ? fmt::format("{:.3f}", *text.reward) : "–"},
      {"return", fmt::format("{:.2f}", text.episode_return)},
  }};
  int x = status.x;
  for (const auto& [label, value] : figures) {
    canvas.Use(kPaleInk);
    canvas.UseFont(kLabelSize);
    canvas.Write(x, status.y + 22, label, column - 8);
    canvas.Use(kInk);
    canvas.UseFont(kValueSize);
    canvas.Write(x, status.y + 46, value, column - 8);
    x += column;
  }
  if (!text.success) return;
  canvas.Use(kGood);
  cairo_rectangle(canvas.context, x, status.y + 14, status.x + status.width - x, 38);
  cairo_fill(canvas.context);
  canvas.Use(kInk);
  canvas.UseFont(18, /*bold=*/true);
  const double free = status.x + status.width - x - canvas.WidthOf("success");
  canvas.Write(x + free / 2, status.y + 39, "success", column);
}

void FilmPicture::Draw(const FilmText& text, std::span<const uint8_t> input,
                       std::span<const uint8_t> view) {
  const size_t frame = size_t(spec_.FrameBytes());
  CHECK(input.size() == size_t(spec_.InputBytes())) << input.size();
  CHECK(view.size() == size_t{3} * kFilmView * kFilmView) << view.size();
  canvas_->Use(kPaper);
  cairo_paint(canvas_->context);
  DrawWords(text);
  cairo_surface_flush(canvas_->surface);  // required before its memory is read directly
  const auto newest = size_t(spec_.stack) - 1;
  for (size_t i = 0; i < layout_.cameras.size(); ++i) {
    const size_t camera = i % spec_.cameras.size(), behind = i / spec_.cameras.size();
    DrawCamera(layout_.cameras[i], camera, input.subspan((newest + behind) * frame, frame));
  }
  DrawView(view);
  cairo_surface_mark_dirty(canvas_->surface);
  if (const auto status = cairo_status(canvas_->context); status != CAIRO_STATUS_SUCCESS) {
    throw RuntimeError("cannot draw '{} {}': {}", text.title, text.subtitle,
                       cairo_status_to_string(status));
  }
}

}  // namespace shoal::launch
