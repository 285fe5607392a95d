#pragma once

#include <string>

#include "base/trace.hpp"

namespace luciole {

/// A trace as JSON in the Trace Event Format, which Perfetto (ui.perfetto.dev) and chrome://tracing open: a
/// complete event ("X") for each event, and metadata ("M") that names processes and tracks. One process is
/// this one with its threads, the other the device with its queue. Times are microseconds since the program's
/// start. command: the command line, for "otherData". Bytes of a text that are no UTF-8 become U+FFFD.
/// Source: "Trace Event Format",
/// https://docs.google.com/document/d/1CvAClvFfyA5R-PhYUmn5OOQtYMH4h6I0nSsKchNAySU
std::string traceJson(const Trace& trace, const std::string& command);

}  // namespace luciole
