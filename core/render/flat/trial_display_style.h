#pragma once

#include "core/base/definition/schema.h"
#include "core/render/gl/colour.h"

namespace haptrial::render {

/// How a trial looks. A pixel of a 19-inch monitor is about 0.29 mm. The colours are apart in
/// brightness or in place as well as in hue, for participants who do not tell blue from green.
struct TrialDisplayStyle {
  // Picture
  int width{1280};      // [px]
  int height{720};      // [px]
  double margin{56.0};  // between the picture's edge and what is drawn, >= 0 [px]
  bool mirrored{false};  // x of W runs to the left: this session's participant is left-handed

  // Spatial trajectory and device position
  double trajectory_width{5.0};  // [px]
  double marker_radius{11.0};    // [px]
  double marker_halo{3.0};       // ring of background around the marker, >= 0 [px]
  double smallest_extent{0.01};  // a shorter trajectory does not fill the picture [m]

  // Force bars above the marker: the target's on the left, the applied force's on the right
  double full_scale{12.0};     // force of a full bar [N]
  double bar_width{22.0};      // [px]
  double bar_height{170.0};    // of a full bar [px]
  double bar_gap{16.0};        // between the two bars, and between marker and bars, >= 0 [px]
  int bar_divisions{4};        // equal parts between the ticks, >= 1; 1: no ticks
  double tick_length{5.0};     // [px]
  double frame_width{1.5};     // of the frame that shows full scale, and of the ticks [px]
  double frame_padding{2.0};   // between the bar and its frame, >= 0 [px]
  double frame_radius{4.0};    // of the frame's corners, >= 0 [px]
  double frame_opacity{0.45};  // 0 to 1
  double panel_opacity{0.85};  // of the background behind a bar, 0 to 1

  // Saturation square, in the top right corner; up to the margin's size it hides no bar
  double saturation_size{26.0};  // side [px]

  Colour background{0xfa / 255.0, 0xfa / 255.0, 0xf8 / 255.0};
  Colour trajectory_colour{0x9a / 255.0, 0xa0 / 255.0, 0xa6 / 255.0};
  Colour marker_colour{0x20 / 255.0, 0x21 / 255.0, 0x24 / 255.0};
  Colour target_colour{0x00 / 255.0, 0x60 / 255.0, 0xb8 / 255.0};
  Colour applied_colour{0x1f / 255.0, 0xa8 / 255.0, 0x6b / 255.0};
  Colour saturation_colour{0xd5 / 255.0, 0x5e / 255.0, 0x00 / 255.0};

  // Room that a marker and its bars need between the trajectory and the picture's edges [px].
  double room_above() const;
  double room_below() const;
  double room_beside() const;
  /// Whether that leaves the trajectory a part of the picture.
  bool leaves_room() const;
};

/// @throws std::invalid_argument naming the value that breaks its bound, or saying that the bars
/// and margins leave no room for the trajectory.
void check(const TrialDisplayStyle& style);

/// The keys of [display] of a trial, all optional.
const Schema<TrialDisplayStyle>& trial_display_schema();

}  // namespace haptrial::render
