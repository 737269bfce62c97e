// The DRD half of the Force Dimension stand-in: opening with a calibration.

#include "tests/support/stand_in_dhd.h"

namespace {
bool initialized = false;
haptrial::test::StandInHandle& handle = haptrial::test::dhd_handle;
}  // namespace

extern "C" {

int dhdOpenID(char index);
int dhdClose(char id);

int drdOpenID(char index) {
  initialized = false;
  handle.note("drdOpen");
  return dhdOpenID(index);
}
int drdClose(char id) { return dhdClose(id); }
bool drdIsSupported(char) { return true; }
bool drdIsInitialized(char) { return initialized; }
int drdAutoInit(char) {
  initialized = true;
  handle.note("auto_init");
  return 0;
}
int drdStop(bool, char) {
  handle.note("drdStop");
  return 0;
}

}  // extern "C"
