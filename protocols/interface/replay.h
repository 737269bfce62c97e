#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/render/gl/image.h"

namespace haptrial::protocols {

/// Request to go through a trial of a recorded session again.
struct ReplayRequest {
  std::filesystem::path file;
  int trial{0};                 // from 1; 0: not said
  std::string phase;            // a word of the protocol; empty: all
  int fps{30};                  // of the pictures
  bool pictures{false};         // whether any are wanted
  std::filesystem::path sound;  // a file for it; empty: none
  /// Takes the pictures in their order.
  std::function<void(const render::Image&)> picture;
  /// How far it is, for a progress line. @throws RunError on an interrupt
  std::function<void(double done, double all, const std::string& what, double rate)> progress;
  std::function<void(const std::string&)> tell;  // takes lines for the terminal
};

}  // namespace haptrial::protocols
