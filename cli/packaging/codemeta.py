#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""codemeta.py CITATION.cff: prints codemeta.json, made from the citation file."""

import json
import sys

import yaml


def codemeta(citation):
    """CodeMeta 2.0 as a dict: the terms that the Citation File Format also has."""
    return {
        "@context": "https://doi.org/10.5063/schema/codemeta-2.0",
        "@type": "SoftwareSourceCode",
        "name": citation["title"].partition(":")[0],
        "description": citation["title"].partition(": ")[2],
        "version": citation["version"],
        "license": "https://spdx.org/licenses/" + citation["license"],
        "programmingLanguage": ["C++", "Python"],
        "operatingSystem": "Linux",
        "author": [{"@type": "Organization", "name": author["name"]} for author in citation["authors"]],
        "referencePublication": [
            {
                "@type": "ScholarlyArticle",
                "name": article["title"],
                "author": [
                    {"@type": "Person", "givenName": person["given-names"], "familyName": person["family-names"]}
                    for person in article["authors"]
                ],
                "isPartOf": {"@type": "Periodical", "name": article["journal"]},
                "datePublished": str(article["year"]),
            }
            for article in citation["references"]
        ],
    }


with open(sys.argv[1], encoding="utf-8") as file:
    print(json.dumps(codemeta(yaml.safe_load(file)), indent=2))
