#!/usr/bin/env bash
# Installs what is missing, builds, and runs `wakeline demo` with the arguments given.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh" demo
exec "$bin/wakeline" demo "$@"
