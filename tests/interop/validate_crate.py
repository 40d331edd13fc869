"""Puts an RO-Crate before roc-validator without the network.

The validator asks the web for the vocabulary that a crate names (its JSON-LD context). Release 0.13 of the package `rocrate`
ships that of RO-Crate 1.1; it goes into the validator's cache, under its address, and the validator runs from there.
"""

import pathlib
import subprocess
import sys
import tempfile

import requests
import requests_cache
import rocrate

ADDRESS = "https://w3id.org/ro/crate/1.1/context"

validator, crate = sys.argv[1:]
context = (pathlib.Path(rocrate.__file__).parent / "data" / "ro-crate.jsonld").read_bytes()
assert ADDRESS.encode() in context, "the vocabulary is that of RO-Crate 1.1"

with tempfile.TemporaryDirectory() as folder:
    cache = f"{folder}/cache"
    session = requests_cache.CachedSession(cache, backend="sqlite", expire_after=-1)
    asked = session.prepare_request(requests.Request("GET", ADDRESS))
    answer = requests_cache.CachedResponse(
        url=ADDRESS,
        status_code=200,
        content=context,
        headers={"Content-Type": "application/ld+json"},
        request=requests_cache.CachedRequest.from_request(asked),
    )
    session.cache.save_response(answer, session.cache.create_key(asked))
    session.close()
    options = ["--no-paging", "--offline", "--cache-path", cache, "--verbose"]
    sys.exit(subprocess.call([validator, "validate", *options, "--requirement-severity", "required", crate]))
