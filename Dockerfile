# A Debian 12 with the package that ./deb.sh makes, and a first landing. `./test.sh bare deb` executes the same lines.
#   docker build -t touchdown .
#   docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/out" -w /out touchdown land straight_turn --html landing.html
FROM debian:12
COPY build/touchdown_*.deb /tmp/
RUN apt-get update
RUN apt-get install -y /tmp/touchdown_*.deb
RUN cd /tmp && touchdown land straight_turn --plot landing.png --html landing.html
RUN cd /tmp && python3 -c "import touchdown as td; print(td.run_trial('open').outcome)"
ENTRYPOINT ["touchdown"]
