// What a program does where there may be no device: it asks first, or takes the error's one line.
#include <cstdio>
#include <luciole/device.hpp>
#include <luciole/error.hpp>

int main() {
  for (const luciole::DeviceDescription& device : luciole::listDevices())
    std::printf("%s, %s\n", device.name.c_str(), device.platform.c_str());
  try {
    luciole::Device::open("gpu");
  } catch (const luciole::InputError& error) {  // there are devices, but none is called so
    std::printf("%s\n", error.what());
  } catch (const luciole::MachineError& error) {  // there is none, or it fails
    std::printf("%s\n", error.what());
  }
}
