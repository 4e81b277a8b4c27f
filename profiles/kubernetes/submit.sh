#!/bin/sh
# submit.sh PROCESSORS MEGABYTES MINUTES JOBSCRIPT: a Kubernetes job with the image, the volume and the folder of this pod.
# Prints its name. SURFEXP_IMAGE, SURFEXP_CLAIM and SURFEXP_VOLUME say which image, which claim, and where it is mounted.
set -eu
: "${SURFEXP_IMAGE:?the image of this pod, e.g. registry.example.org/surfexp:1}"
: "${SURFEXP_CLAIM:?the claim of the volume that holds this folder, e.g. surfexp}"
: "${SURFEXP_VOLUME:?where the volume is mounted, e.g. /work}"
kubectl create --output name --filename - <<MANIFEST
apiVersion: batch/v1
kind: Job
metadata: {generateName: surfexp-, labels: {app: surfexp}}
spec:
  backoffLimit: 0
  activeDeadlineSeconds: $(($3 * 60))
  ttlSecondsAfterFinished: 86400
  template:
    metadata: {labels: {app: surfexp}}
    spec:
      restartPolicy: Never
      containers:
        - name: stages
          image: "$SURFEXP_IMAGE"
          workingDir: "$PWD"
          command: [sh, "$4"]
          env: [{name: XDG_CACHE_HOME, value: "$SURFEXP_VOLUME/.cache"}]
          resources:
            requests: {cpu: "$1", memory: "${2}M"}
            limits: {memory: "${2}M"}
          volumeMounts: [{name: volume, mountPath: "$SURFEXP_VOLUME"}]
      volumes: [{name: volume, persistentVolumeClaim: {claimName: "$SURFEXP_CLAIM"}}]
MANIFEST
