#!/usr/bin/env python3
"""What an edit of a city costs in the studio, as the browser gets it.

    tests/external/studio_city.py EDIFICE CITY.city-grammar.json[.gz]

Opens the city, scales the templates with the most instances one after another, undoes it all, and prints the bytes and the
seconds of each answer. Fails where an answer has more than 100,000 bytes or the city takes more than three seconds to open.
"""

import collections
import http.client
import json
import subprocess
import sys
import time
import urllib.parse

MOST_BYTES = 100_000
MOST_SECONDS = 3.0
EDITED = 3


def main():
    """Runs the studio and asks it."""
    program, city = sys.argv[1:]
    server = subprocess.Popen([program, "studio", "--no-open", "--read-only", city], stdout=subprocess.PIPE, text=True)
    try:
        address = urllib.parse.urlparse(server.stdout.readline().split()[-1])
        token = urllib.parse.parse_qs(address.fragment)["token"][0]
        failed = asked(address.netloc, token)
    finally:
        server.terminate()
        server.wait()
    sys.exit(1 if failed else 0)


def asked(host, token):
    """Edits and undoes; True where an answer is too long or too late."""
    headers = {"x-edifice-token": token, "content-type": "application/json", "accept-encoding": "gzip"}

    def call(method, path, body=None):
        start = time.monotonic()
        connection = http.client.HTTPConnection(host, timeout=600)
        connection.request(method, "/api" + path, None if body is None else json.dumps(body), headers)
        answer = connection.getresponse()
        raw = answer.read()
        if answer.headers.get("content-encoding") == "gzip":
            import gzip

            text = gzip.decompress(raw)
        else:
            text = raw
        assert answer.status < 300, (answer.status, text[:300])
        return answer.status, len(raw), time.monotonic() - start, json.loads(text)

    _, size, seconds, document = call("GET", "/documents/d1")
    print(f"open: {size} bytes, {seconds:.2f} s")
    failed = seconds > MOST_SECONDS
    count = collections.Counter(i[0] for i in document["view"]["instances"])
    templates = document["view"]["templates"]
    shown = document["revision"]

    def told(way, body):
        status, size, seconds, answer = call("POST", f"/documents/d1/{way}", body)
        if status == 202:
            job = answer["job"]
            while job["state"] == "running":
                time.sleep(0.02)
                job = call("GET", f"/jobs/{job['id']}")[3]["job"]
            assert job["state"] == "done", job
            _, size, more, answer = call("GET", f"/documents/d1?shows={body['shows']}")
            seconds += more
        print(f"{way}: {size} bytes, {seconds:.2f} s")
        return size > MOST_BYTES, answer["revision"]

    for template, instances in count.most_common(EDITED):
        symbol = templates[template]["symbol"]
        print(f"template {symbol}: {instances} instances")
        for factors in ["1.1,1.2,0.9", "1.07,0.93,1.3"]:
            edit = {"do": "edit", "edits": [f"scale {symbol}={factors}"]}
            long, shown = told("edit", {"commands": [edit], "revision": shown, "shows": shown})
            failed |= long
    for _ in range(2 * EDITED):
        long, shown = told("undo", {"shows": shown})
        failed |= long
    return failed


if __name__ == "__main__":
    main()
