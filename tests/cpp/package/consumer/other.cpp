#include <wakeline/wakeline.hpp>

int other();

int other() { return 0; }
