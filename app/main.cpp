#include "app/program.hpp"

int main(int argc, char** argv) {
  return lodestar::program(argc, argv);
}
