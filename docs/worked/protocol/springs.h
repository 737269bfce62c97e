#pragma once

#include "experiments/studies/study.h"

/// A protocol of one's own: two springs are felt one after the other, and the participant says with
/// a button which was stiffer. Their difference follows a staircase: two right answers in a row
/// make it smaller, a wrong one larger. Beside it: a page for an assistant, and a stream of how
/// deep the springs are pressed.
const haptrial::experiments::Study& springs();
