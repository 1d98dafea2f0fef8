#include <arv.h>
#include <csignal>
#include <cstdio>

// A GigE Vision camera on the loopback interface, Aravis' own, until it is told to end: what service_trials
// pulls.
int main() {
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGTERM);
  sigaddset(&ends, SIGINT);
  sigprocmask(SIG_BLOCK, &ends, nullptr);  // before the camera's thread begins
  ArvGvFakeCamera* camera = arv_gv_fake_camera_new("127.0.0.1", "trial");
  if (camera == nullptr || !arv_gv_fake_camera_is_running(camera)) {
    std::fprintf(stderr, "fake_camera: 127.0.0.1 is taken\n");
    return 1;
  }
  int signal = 0;
  sigwait(&ends, &signal);
  g_object_unref(camera);
  return 0;
}
