# The command line and the page: docker build -t stridula . && docker run --rm -p 8707:8707 stridula
# Other verbs: docker run --rm -v "$PWD:/work" stridula run squeal --out squeal.nc
FROM python:3.12-slim

WORKDIR /sources
COPY pyproject.toml README.md LICENSE ./
COPY src src
RUN pip install --no-cache-dir ".[all]" \
    && useradd --create-home player \
    && mkdir /work && chown player /work

USER player
WORKDIR /work
# Compiled once, here, instead of at each start of a container.
RUN stridula run squeal --duration 0.01

EXPOSE 8707
ENTRYPOINT ["stridula"]
# Whoever reaches the port of the host may play; a browser takes it for a secure page only as localhost.
CMD ["app", "--host", "0.0.0.0", "--open", "--no-browser"]
