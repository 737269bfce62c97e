#pragma once

#include <chrono>
#include <memory>

namespace haptrial::bone {

class BoneWorld;

/// A background thread that calls BoneWorld::search() over and over. Source: Morris 2006, §3.2.6.
class PiecesSearch {
 public:
  /// @param pause  between two searches
  explicit PiecesSearch(BoneWorld& world,
                        std::chrono::milliseconds pause = std::chrono::milliseconds(10));
  /// Ends the search that runs, and the thread.
  ~PiecesSearch();
  PiecesSearch(const PiecesSearch&) = delete;
  PiecesSearch& operator=(const PiecesSearch&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::bone
