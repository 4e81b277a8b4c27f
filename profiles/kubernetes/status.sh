#!/bin/sh
# status.sh JOB: success, failed or running, as Snakemake asks for it. A job that is gone has failed.
conditions=$(kubectl get "$1" --ignore-not-found --output 'jsonpath=found {.status.conditions[?(@.status=="True")].type}') || {
    echo running # the API server does not answer: asked again
    exit
}
case $conditions in
    *Complete*) echo success ;;
    *Failed* | "") echo failed ;;
    *) echo running ;;
esac
