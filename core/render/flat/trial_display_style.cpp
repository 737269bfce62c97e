#include "core/render/flat/trial_display_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptrial::render {
namespace {

constexpr long kSmallestSide = 160;  // [px]
constexpr long kLargestSide = 8192;  // [px]
constexpr double kLeastRoom = 32.0;  // for the trajectory, each way [px]
constexpr Bounds kPixels{0.0, static_cast<double>(kLargestSide), true};
constexpr Bounds kPixelsOrNone{0.0, static_cast<double>(kLargestSide), false};

/// Text of a colour as a definition writes it.
std::string words_of(const Colour& colour) {
  const auto byte = [](double share) { return static_cast<int>(std::lround(255.0 * share)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.red), byte(colour.green),
                     byte(colour.blue));
}

using Style = TrialDisplayStyle;

/// A key with a colour, "#rrggbb".
void add_colour(Schema<Style>& schema, const char* name, Colour Style::*member,
                const char* description) {
  schema
      .custom(name, description,
              [member](Table& table, const std::string& key, Style& style) {
                const std::string text = table.text(key);
                if (const auto colour = parse_colour(text)) {
                  style.*member = *colour;
                } else if (!text.empty()) {  // else noted by text()
                  table.reject(key, fmt::format("'{}'", text),
                               "a colour \"#rrggbb\" in hexadecimal digits");
                }
              })
      .otherwise(words_of(Style{}.*member));
}

void check_room(Table& display, Style& style) {
  if (!style.leaves_room()) {
    display.reject("height",
                   fmt::format("{} px with a width of {} px, margins of {} px and bars of {} px",
                               style.height, style.width, style.margin, style.bar_height),
                   fmt::format("sizes that leave the trajectory {} px each way", kLeastRoom));
  }
}

Schema<Style> make_schema() {
  using S = Style;
  Schema<S> schema;
  schema
      .integer("width", &S::width, kSmallestSide, kLargestSide, "Width of pictures and of a window")
      .integer("height", &S::height, kSmallestSide, kLargestSide,
               "Height of pictures and of a window")
      .number("margin", &S::margin, kPixelsOrNone, "px",
              "Room between the picture's edge and what is drawn")
      .number("trajectory_width", &S::trajectory_width, kPixels, "px",
              "Width of the line of the trajectory")
      .number("marker_radius", &S::marker_radius, kPixels, "px", "Radius of the marker of the hand")
      .number("full_scale", &S::full_scale, kPositive, "N",
              "Force of a full bar; larger forces fill the bar")
      .number("bar_width", &S::bar_width, kPixels, "px", "Width of the bars of force")
      .number("bar_height", &S::bar_height, kPixels, "px", "Height of a full bar of force")
      .number("bar_gap", &S::bar_gap, kPixelsOrNone, "px",
              "Gap between the bars of force, and between the marker and the bars")
      .number("saturation_size", &S::saturation_size, kPixels, "px",
              "Side of the square that shows that the force limit is reached");
  add_colour(schema, "background", &S::background, "Colour behind everything");
  add_colour(schema, "trajectory_colour", &S::trajectory_colour, "Colour of the trajectory");
  add_colour(schema, "marker_colour", &S::marker_colour, "Colour of the marker of the hand");
  add_colour(schema, "target_colour", &S::target_colour, "Colour of the bar of the target force");
  add_colour(schema, "applied_colour", &S::applied_colour,
             "Colour of the bar of the applied force");
  add_colour(schema, "saturation_colour", &S::saturation_colour,
             "Colour of the square that shows that the force limit is reached");
  schema.check(check_room);
  return schema;
}

void require(bool good, std::string_view name, double value, std::string_view allowed) {
  if (!good) {
    throw std::invalid_argument(fmt::format("{} is {}; allowed: {}", name, value, allowed));
  }
}

void require_positive(std::string_view name, double value) {
  require(value > 0.0 && std::isfinite(value), name, value, "a number above 0");
}

void require_not_negative(std::string_view name, double value) {
  require(value >= 0.0 && std::isfinite(value), name, value, "a number from 0");
}

void require_fraction(std::string_view name, double value) {
  require(value >= 0.0 && value <= 1.0, name, value, "a number from 0 to 1");
}

}  // namespace

double TrialDisplayStyle::room_above() const {
  return margin + marker_radius + bar_gap + bar_height + frame_padding + frame_width;
}

double TrialDisplayStyle::room_beside() const {
  return margin + std::max(marker_radius,
                           0.5 * bar_gap + bar_width + frame_padding + frame_width + tick_length);
}

double TrialDisplayStyle::room_below() const { return margin + marker_radius; }

bool TrialDisplayStyle::leaves_room() const {
  return width - 2.0 * room_beside() >= kLeastRoom &&
         height - room_above() - room_below() >= kLeastRoom;
}

void check(const TrialDisplayStyle& style) {
  require_positive("trajectory_width", style.trajectory_width);
  require_positive("marker_radius", style.marker_radius);
  require_positive("smallest_extent", style.smallest_extent);
  require_positive("full_scale", style.full_scale);
  require_positive("bar_width", style.bar_width);
  require_positive("bar_height", style.bar_height);
  require_positive("frame_width", style.frame_width);
  require_positive("saturation_size", style.saturation_size);
  require_not_negative("margin", style.margin);
  require_not_negative("marker_halo", style.marker_halo);
  require_not_negative("bar_gap", style.bar_gap);
  require_not_negative("tick_length", style.tick_length);
  require_not_negative("frame_padding", style.frame_padding);
  require_not_negative("frame_radius", style.frame_radius);
  require_fraction("frame_opacity", style.frame_opacity);
  require_fraction("panel_opacity", style.panel_opacity);
  require(style.bar_divisions >= 1, "bar_divisions", style.bar_divisions, "a whole number from 1");
  if (!style.leaves_room()) {
    throw std::invalid_argument(
        fmt::format("a picture of {} x {} pixels leaves no room for the trajectory beside margins "
                    "of {} and bars of {} pixels",
                    style.width, style.height, style.margin, style.bar_height));
  }
}

const Schema<TrialDisplayStyle>& trial_display_schema() {
  static const auto schema = make_schema();
  return schema;
}

}  // namespace haptrial::render
