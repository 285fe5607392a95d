#include "cl/driver_call.hpp"

namespace luciole {
namespace {

thread_local int calls = 0;

}  // namespace

bool isInDriver() noexcept { return calls > 0; }

DriverCall::DriverCall() noexcept { ++calls; }
DriverCall::~DriverCall() { --calls; }

}  // namespace luciole
