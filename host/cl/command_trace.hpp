#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "base/trace.hpp"
#include "cl/device.hpp"
#include "cl/driver_call.hpp"

// The commands of a device's queue (kernels and copies) in a trace, with times of OpenCL's profiling events.
namespace luciole {

/// A queued command that isn't recorded yet.
struct QueuedCommand {
  cl::Event event;
  std::string name;
  TraceArguments arguments;
  std::int64_t before, after;  ///< when the host began to queue it and was done with that
};

/// The trace of a device's queue.
///
/// The device's clock is synchronized to the host's by the commands: the device has the time at which a
/// command was queued, and the host knows that this was between `before` and `after`. The offset is taken
/// from the command with the shortest such interval; its error is half of the interval. The error grows by
/// 0.5 ms a second, the most by which Linux slews a clock (adjtimex(2)), until another command gives a
/// smaller one.
struct CommandTrace {
  std::size_t track;
  std::vector<QueuedCommand> commands{};
  std::int64_t host_minus_device = 0;                      ///< nanoseconds to add to the device's times
  double error = std::numeric_limits<double>::infinity();  ///< of the offset, in nanoseconds, at that time
  std::int64_t tied = 0;                                   ///< the time of the last synchronization
  std::int64_t last_end = 0;                               ///< of the commands recorded so far
};

/// Records the commands that are done. Without a trace it does nothing. Throws MachineError where the device
/// doesn't tell.
void recordCommands(OpenedDevice& device);

/// See queueCommand().
void noteCommand(OpenedDevice& device, QueuedCommand&& command);

/// Calls enqueue(cl::Event*), which queues one command and has OpenCL fill in the event, and notes the
/// command for recordCommands(). Without a trace the pointer is null, and nothing is noted.
template <class Enqueue>
void queueCommand(OpenedDevice& device, const char* name, std::initializer_list<TraceArgument> arguments,
                  Enqueue&& enqueue) {
  if (!device.trace) {
    callDriver([&] { enqueue(static_cast<cl::Event*>(nullptr)); });
    return;
  }
  QueuedCommand command{{}, name, traceArguments(arguments), nanosecondsSinceStart(), 0};
  callDriver([&] { enqueue(&command.event); });
  command.after = nanosecondsSinceStart();
  noteCommand(device, std::move(command));
}

}  // namespace luciole
