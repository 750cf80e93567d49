# A slim image without a GPU that runs as an ordinary user: docs/batch.md says how.
FROM python:3.12-slim AS build
WORKDIR /source
COPY . .
RUN python -m venv /opt/tiskel \
 && /opt/tiskel/bin/pip install --no-cache-dir --constraint constraints.txt '.[full,cluster]'

FROM python:3.12-slim
COPY --from=build /opt/tiskel /opt/tiskel
# Any user may keep compiled kernels there; a volume keeps them from one container to the next.
RUN mkdir -m 1777 /cache
ENV PATH=/opt/tiskel/bin:$PATH XDG_CACHE_HOME=/cache MPLCONFIGDIR=/tmp/matplotlib HOME=/tmp
USER 1000
WORKDIR /work
ENTRYPOINT ["tiskel"]
CMD ["--help"]
