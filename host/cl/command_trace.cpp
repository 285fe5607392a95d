#include "cl/command_trace.hpp"

#include <algorithm>
#include <cmath>

#include "cl/device_error.hpp"

namespace luciole {
namespace {

/// The largest drift between the device's clock and the host's, without unit (see CommandTrace).
constexpr double kMostSlew = 500e-6;

/// A command that is done, by the device's clock.
struct DoneCommand {
  QueuedCommand command;
  std::int64_t queued, submitted, start, end;
};

/// Removes the completed commands from the list and returns them. Failed ones are dropped: finish() reports
/// them.
std::vector<DoneCommand> takeDone(std::vector<QueuedCommand>& commands) {
  std::vector<DoneCommand> done;
  std::vector<QueuedCommand> left;
  for (QueuedCommand& command : commands) {
    const cl_int status = command.event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>();
    if (status != CL_COMPLETE) {
      if (status > CL_COMPLETE) left.push_back(std::move(command));
      continue;
    }
    const cl::Event event = command.event;
    done.push_back({std::move(command), std::int64_t(event.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>()),
                    std::int64_t(event.getProfilingInfo<CL_PROFILING_COMMAND_SUBMIT>()),
                    std::int64_t(event.getProfilingInfo<CL_PROFILING_COMMAND_START>()),
                    std::int64_t(event.getProfilingInfo<CL_PROFILING_COMMAND_END>())});
  }
  commands = std::move(left);
  // Threads that queue at once may have noted in another order.
  std::sort(done.begin(), done.end(),
            [](const DoneCommand& a, const DoneCommand& b) { return a.start < b.start; });
  return done;
}

double errorAt(const CommandTrace& trace, std::int64_t now) {
  return trace.error + kMostSlew * std::abs(double(now - trace.tied));
}

/// Synchronizes the clocks by the command if that reduces the error.
void synchronize(const DoneCommand& done, CommandTrace& trace) {
  const auto& [event, name, arguments, before, after] = done.command;
  const double error = 0.5 * double(after - before);
  if (error > errorAt(trace, before)) return;
  trace.host_minus_device = before + (after - before) / 2 - done.queued;
  trace.error = error;
  trace.tied = before;
}

}  // namespace

void noteCommand(OpenedDevice& device, QueuedCommand&& command) {
  const std::lock_guard lock(device.notes_mutex);
  device.trace->commands.push_back(std::move(command));
}

void recordCommands(OpenedDevice& device) {
  if (!device.trace) return;
  const std::lock_guard lock(device.notes_mutex);
  CommandTrace& trace = *device.trace;
  std::vector<DoneCommand> all;
  try {
    all = takeDone(trace.commands);
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
  const std::int64_t now = nanosecondsSinceStart();
  for (const DoneCommand& done : all) synchronize(done, trace);
  for (DoneCommand& done : all) {
    // Bounds that hold whatever the clocks' error: a command ran after `before`, ended before now, and ran
    // after the command before it, since the queue is in order.
    const auto hostTime = [&](std::int64_t device_time, std::int64_t earliest) {
      return std::clamp(device_time + trace.host_minus_device, earliest, now);
    };
    const std::int64_t queued = hostTime(done.queued, done.command.before);
    const std::int64_t submitted = hostTime(done.submitted, queued);
    const std::int64_t start = hostTime(done.start, std::max(submitted, trace.last_end));
    trace.last_end = hostTime(done.end, start);
    TraceArguments arguments = std::move(done.command.arguments);
    arguments.emplace_back("queued_us", 1e-3 * double(queued));
    arguments.emplace_back("submitted_us", 1e-3 * double(submitted));
    arguments.emplace_back("clock_error_us", 1e-3 * errorAt(trace, start));
    traceEvent({std::move(done.command.name), kTraceDevice, trace.track, start, trace.last_end,
                std::move(arguments)});
  }
}

}  // namespace luciole
