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

void read_side(Table& table, std::string_view key, int& value) {
  value = table.integer_or(key, value, kSmallestSide, kLargestSide);
}

void read_number(Table& table, std::string_view key, const Bounds& bounds, std::string_view unit,
                 double& value) {
  value = table.number_or(key, value, bounds, unit);
}

/// Text of a colour as a definition writes it.
std::string words_of(const Colour& colour) {
  const auto byte = [](double share) { return static_cast<int>(std::lround(255.0 * share)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.red), byte(colour.green),
                     byte(colour.blue));
}

void read_colour(Table& table, std::string_view key, Colour& value) {
  table.otherwise(key, words_of(value));
  if (!table.has(key)) {
    return;
  }
  const std::string text = table.text(key);
  if (text.empty()) {
    return;  // noted by text()
  }
  if (const auto colour = parse_colour(text)) {
    value = *colour;
  } else {
    table.reject(key, fmt::format("'{}'", text), "a colour \"#rrggbb\" in hexadecimal digits");
  }
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

TrialDisplayStyle read_trial_display_style(Table& display) {
  TrialDisplayStyle style;
  read_side(display, "width", style.width);
  read_side(display, "height", style.height);
  read_number(display, "margin", kPixelsOrNone, "px", style.margin);
  read_number(display, "trajectory_width", kPixels, "px", style.trajectory_width);
  read_number(display, "marker_radius", kPixels, "px", style.marker_radius);
  read_number(display, "full_scale", kPositive, "N", style.full_scale);
  read_number(display, "bar_width", kPixels, "px", style.bar_width);
  read_number(display, "bar_height", kPixels, "px", style.bar_height);
  read_number(display, "bar_gap", kPixelsOrNone, "px", style.bar_gap);
  read_number(display, "saturation_size", kPixels, "px", style.saturation_size);
  read_colour(display, "background", style.background);
  read_colour(display, "trajectory_colour", style.trajectory_colour);
  read_colour(display, "marker_colour", style.marker_colour);
  read_colour(display, "target_colour", style.target_colour);
  read_colour(display, "applied_colour", style.applied_colour);
  read_colour(display, "saturation_colour", style.saturation_colour);
  if (!style.leaves_room()) {
    display.reject("height",
                   fmt::format("{} px with a width of {} px, margins of {} px and bars of {} px",
                               style.height, style.width, style.margin, style.bar_height),
                   fmt::format("sizes that leave the trajectory {} px each way", kLeastRoom));
  }
  return style;
}

}  // namespace haptrial::render
