#include "machine/stop_reading.h"

#include <utility>

namespace vdbeam {
namespace {

thread_local const StopToken* reading_stop = nullptr;

} // namespace

StopReading::StopReading(const StopToken& stop) : before_(std::exchange(reading_stop, &stop)) {}

StopReading::~StopReading() {
  reading_stop = before_;
}

const StopToken* StopReading::token() {
  return reading_stop;
}

void StopReading::check() {
  if (reading_stop)
    reading_stop->check();
}

} // namespace vdbeam
