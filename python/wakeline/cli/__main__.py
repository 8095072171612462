"""``python -m wakeline.cli`` is the ``wakeline`` command."""

import sys

from . import main

sys.exit(main())
