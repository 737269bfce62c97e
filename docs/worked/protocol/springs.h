#pragma once

#include "experiments/studies/study.h"

/// A protocol of one's own: two springs are felt one after the other, and the participant says with
/// a button which was stiffer. Their difference follows a staircase: two right answers in a row
/// make it smaller, a wrong one larger.
const haptrial::experiments::Study& springs();
