#include "core/progress.h"

namespace radiosity {

void Progress::update(std::string_view phase, double done) const {
  if (report) {
    report(phase, done);
  }
  if (cancelled && cancelled()) {
    throw Cancelled{};
  }
}

}  // namespace radiosity
