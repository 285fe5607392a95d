#include "tools/cli/signals.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>

#include "base/cleanup.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"

namespace luciole {
namespace {

/// Of whoever ends the process. Nobody gives it back.
std::mutex ending;

[[noreturn]] void endBySignal(int signal) {
  ending.lock();
  cleanUp();
  const int status = 128 + signal;
  if (!logsEvents() && isatty(STDERR_FILENO)) writeError("\r\x1b[K");  // the line of progress
  try {
    reportError(fmt::format("ended by SIG{}", sigabbrev_np(signal)), status);
  } catch (const std::exception&) {  // no memory
  }
  logEnd(status);
  // Shells go on after a Ctrl-C unless the program that it ended tells them by its own end.
  if (signal == SIGINT) {
    sigset_t one;
    sigemptyset(&one);
    sigaddset(&one, signal);
    ::signal(signal, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
    raise(signal);
  }
  std::_Exit(status);
}

}  // namespace

void awaitSignals() {
  static sigset_t awaited;
  sigemptyset(&awaited);
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
    struct sigaction action {};
    // Who is told to ignore it, as by nohup, would be given it by sigwait() all the same.
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) sigaddset(&awaited, signal);
  }
  // All threads inherit the mask, those of OpenCL too.
  pthread_sigmask(SIG_BLOCK, &awaited, nullptr);
  const auto wait = [](void*) -> void* {
    int signal = 0;
    while (sigwait(&awaited, &signal) != 0) continue;
    endBySignal(signal);
  };
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
  // The usual 8 MiB would be missing where addresses are limited.
  pthread_attr_setstacksize(&attributes, std::size_t(256) << 10);
  pthread_t thread{};
  // Where no thread can be had, signals end the process as they always do.
  if (pthread_create(&thread, &attributes, wait, nullptr) != 0)
    pthread_sigmask(SIG_UNBLOCK, &awaited, nullptr);
  pthread_attr_destroy(&attributes);
}

void ignoreSignals() { ending.lock(); }

}  // namespace luciole
