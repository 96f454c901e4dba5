// Linked into the program, takes AVX and all that came after it away from what chooses code by the processor: functions that the
// compiler made several of, and Embree.
#include <dlfcn.h>
#include <embree3/rtcore.h>

#include <string>

extern "C" {

// What libgcc would fill in: nothing is there beyond what every x86-64 has.
unsigned __cpu_model[4];
unsigned __cpu_features2[8];
int __cpu_indicator_init() {
  return 0;
}

RTCDevice rtcNewDevice(const char* config) {
  const auto of_library = reinterpret_cast<RTCDevice (*)(const char*)>(dlsym(RTLD_NEXT, "rtcNewDevice"));
  return of_library((std::string(config ? config : "") + ",isa=sse2").c_str());
}
}
