#pragma once

namespace haptrial::experiments {

/// Adds the studies that haptrial comes with, one line each, the default one first. Once a program.
void add_shipped_studies();

}  // namespace haptrial::experiments
