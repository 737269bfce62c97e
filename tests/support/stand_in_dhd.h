#pragma once

#include "tests/support/stand_in_handle.h"

namespace haptrial::test {

extern StandInHandle dhd_handle;  // shared by the DHD and the DRD half
extern int dhd_error;

}  // namespace haptrial::test
